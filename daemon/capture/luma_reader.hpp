#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "core/grey_image.hpp"
#include "daemon/capture/pixel_format.hpp"
#include "daemon/jpeg_decoder.hpp"

namespace roundel {

// A part of a picture, pixels. No width: all of it.
struct Crop {
  int left = 0, top = 0, width = 0, height = 0;
  bool empty() const { return width == 0; }
};

// How the driver lays out the first plane of its frames.
struct FrameLayout {
  PixelFormat format;
  int width = 0, height = 0;  // pixels of the sensor's picture
  int row_stride = 0;         // bytes; not for JPEG
};

// Makes luma views of captured frames: in place where the format allows, otherwise in a buffer of
// its own that every frame uses again.
class LumaReader {
 public:
  // Throws CameraError if the layout can't be, or the crop is not inside of it.
  LumaReader(const FrameLayout& layout, const Crop& crop);

  // Of the views.
  int width() const { return crop_.width / layout_.format.cell; }
  int height() const { return crop_.height / layout_.format.cell; }
  // Whether a view is of the frame's own memory. Otherwise the frame can be given back at once.
  bool in_place() const { return layout_.format.reading == Reading::kInPlace; }

  // Nothing if the frame is damaged: shorter than its luma, or no JPEG of its size. The view holds
  // until the next call, and, in place, as long as the frame.
  std::optional<LumaView> read(std::span<const std::uint8_t> frame);

 private:
  std::size_t needed_bytes() const;
  LumaView view_in_place(const std::uint8_t* frame) const;
  LumaView gather(const std::uint8_t* frame);
  std::optional<LumaView> decode(std::span<const std::uint8_t> frame);

  FrameLayout layout_;
  Crop crop_;  // never empty
  GreyImage image_;
  std::optional<JpegDecoder> decoder_;
};

}  // namespace roundel
