#pragma once

#include <cstddef>
#include <cstdint>

namespace roundel {

// A borrowed view of the luma samples of one frame, wherever they lie: pixel (u, v) is the byte at
// data + v * row_stride + u * pixel_stride. Owns nothing; the memory must outlive the view.
struct LumaView {
  const std::uint8_t* data = nullptr;
  int width = 0;                    // pixels
  int height = 0;                   // rows
  std::ptrdiff_t row_stride = 0;    // bytes from one row to the next; negative for bottom-up images
  std::ptrdiff_t pixel_stride = 1;  // bytes from one luma sample to the next

  const std::uint8_t* row(int v) const { return data + v * row_stride; }
  std::uint8_t at(int u, int v) const { return row(v)[u * pixel_stride]; }
  bool contains(int u, int v) const { return u >= 0 && v >= 0 && u < width && v < height; }
  bool empty() const { return data == nullptr || width <= 0 || height <= 0; }
};

// 8-bit grey, and the luma plane of planar formats (NV12, NV21, YU12, YV12, ...).
inline LumaView grey_view(const std::uint8_t* data, int width, int height,
                          std::ptrdiff_t row_stride) {
  return {data, width, height, row_stride, 1};
}

// Packed 4:2:2 with luma first: YUYV and YVYU.
inline LumaView yuyv_view(const std::uint8_t* data, int width, int height,
                          std::ptrdiff_t row_stride) {
  return {data, width, height, row_stride, 2};
}

// Packed 4:2:2 with chroma first: UYVY and VYUY.
inline LumaView uyvy_view(const std::uint8_t* data, int width, int height,
                          std::ptrdiff_t row_stride) {
  return {data + 1, width, height, row_stride, 2};
}

}  // namespace roundel
