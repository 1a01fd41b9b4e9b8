#pragma once

#include <cairo.h>

#include <cstdint>

#include "core/marker_geometry.hpp"

namespace roundel {

// What is printed inside the outer black circle. WhyCode: `bits` in [kMinBits, kMaxBits] and the
// canonical word of the id. Plain WhyCon: bits == 0 and the white centre's radius as a share of the
// black one's.
struct MarkerPattern {
  int bits = 0;
  std::uint32_t word = 0;
  double plain_inner_ratio = kPlainInnerRatio;
};

// Draws the pattern as exact arcs: black disc of this radius about (x, y), and what is white in it
// (MARKERS.md sections 2.1 and 2.2). The white margin around the disc is the caller's business.
// Seen with x to the right and y down (cairo's and every page's way), the canonical word begins at
// 3 o'clock, which is the marker's x axis, and runs counter-clockwise.
void draw_marker(cairo_t* context, const MarkerPattern& pattern, double x, double y, double radius);

}  // namespace roundel
