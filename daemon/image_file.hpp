#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/grey_image.hpp"
#include "core/luma_view.hpp"

namespace roundel {

// Wider or higher images are refused, whatever their header promises.
inline constexpr int kMaxImageSide = 16384;

// Reads image files as luma: PNG (any kind; colour by BT.601, 16 bits rounded to 8, transparent
// parts as over white paper), JPEG (its luma plane), PGM (P2 and P5, up to 16 bits). The kind is
// told by the contents, not by the name. Keeps its buffers, and the image keeps its own, so loading
// images of one size after another hardly allocates.
class ImageLoader {
 public:
  // Throws std::runtime_error that names the file and what is wrong with it: missing, not an image,
  // truncated, damaged, too large. The image's contents are unspecified then.
  void load(const std::string& path, GreyImage& image);

 private:
  std::vector<std::uint8_t> bytes_;
};

GreyImage load_image(const std::string& path);

// Writes 8-bit grey PNG; with its resolution, for printing, where one is given. Throws
// std::runtime_error that names the file.
void save_png(const std::string& path, const LumaView& image, double pixels_per_metre = 0);

}  // namespace roundel
