#include "tools/marker_pattern.hpp"

#include <cmath>
#include <numbers>

namespace roundel {
namespace {

constexpr double kPi = std::numbers::pi;

// The teeth reach under the black ring, so that no light seam shows where they meet it.
constexpr double kToothRatio = 0.8;

void fill_disc(cairo_t* context, double x, double y, double radius, double grey) {
  cairo_new_path(context);
  cairo_arc(context, x, y, radius, 0, 2 * kPi);
  cairo_set_source_rgb(context, grey, grey, grey);
  cairo_fill(context);
}

// Is the half-tooth white? Half-tooth 2i is bit i's first half, counter-clockwise, bit 0 the most
// significant: white for a one. The second half is the other colour.
bool is_white(const MarkerPattern& pattern, int half) {
  const bool bit = (pattern.word >> (pattern.bits - 1 - half / 2) & 1U) != 0;
  return bit == (half % 2 == 0);
}

void draw_teeth(cairo_t* context, const MarkerPattern& pattern, double x, double y, double radius) {
  const int halves = 2 * pattern.bits;
  const double width = 2 * kPi / halves;
  cairo_new_path(context);
  for (int first = 0; first < halves;) {
    int last = first;
    while (last < halves && !is_white(pattern, last)) {
      ++last;  // neighbours of one colour are one tooth: again no seam
    }
    if (last > first) {
      // Counter-clockwise as seen is negative where y points down.
      cairo_move_to(context, x, y);
      cairo_arc_negative(context, x, y, kToothRatio * radius, -first * width, -last * width);
      cairo_close_path(context);
    }
    first = last + 1;
  }
  cairo_set_source_rgb(context, 0, 0, 0);
  cairo_fill(context);
}

}  // namespace

void draw_marker(cairo_t* context, const MarkerPattern& pattern, double x, double y,
                 double radius) {
  cairo_save(context);
  cairo_set_antialias(context, CAIRO_ANTIALIAS_BEST);
  // Arcs become Bezier curves that stay this close to the circle.
  cairo_set_tolerance(context, 1e-3);
  fill_disc(context, x, y, radius, 0);
  if (pattern.bits == 0) {
    fill_disc(context, x, y, pattern.plain_inner_ratio * radius, 1);
  } else {
    fill_disc(context, x, y, kCodeOuterRatio * radius, 1);
    draw_teeth(context, pattern, x, y, radius);
    fill_disc(context, x, y, kCodeInnerRatio * radius, 1);
  }
  cairo_restore(context);
}

}  // namespace roundel
