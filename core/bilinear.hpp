#pragma once

#include <cmath>

#include "core/luma_view.hpp"

namespace roundel {

// Whether the four pixels around (u, v) lie in the frame.
inline bool can_interpolate(const LumaView& frame, double u, double v) {
  return u >= 0 && v >= 0 && u < frame.width - 1 && v < frame.height - 1;
}

// Luma between pixel centres, grey levels; can_interpolate(frame, u, v) must hold.
inline double interpolate(const LumaView& frame, double u, double v) {
  const int u0 = static_cast<int>(u), v0 = static_cast<int>(v);
  const double fu = u - u0, fv = v - v0;
  const std::uint8_t* p = frame.row(v0) + u0 * frame.pixel_stride;
  const std::uint8_t* q = p + frame.row_stride;
  const std::ptrdiff_t next = frame.pixel_stride;
  const double upper = p[0] + fu * (p[next] - p[0]);
  const double lower = q[0] + fu * (q[next] - q[0]);
  return upper + fv * (lower - upper);
}

}  // namespace roundel
