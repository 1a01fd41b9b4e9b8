#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/luma_view.hpp"

namespace roundel {

// An 8-bit grey image that owns its pixels. Invariant: pixels.size() == width * height, row by row.
struct GreyImage {
  int width = 0, height = 0;
  std::vector<std::uint8_t> pixels;

  // Contents are unspecified afterwards; storage is kept when shrinking.
  void resize(int new_width, int new_height) {
    width = new_width;
    height = new_height;
    pixels.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  }
  std::uint8_t& at(int u, int v) {
    return pixels[static_cast<std::size_t>(v) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(u)];
  }
  LumaView view() const { return grey_view(pixels.data(), width, height, width); }
};

}  // namespace roundel
