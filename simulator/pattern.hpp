#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "core/marker_geometry.hpp"

namespace roundel {

// Outlines of what is printed, as polygons in the printed plane (x right, y up on the page),
// counter-clockwise on the printed face. Each function calls emit(point) for every corner.
//
// Arcs are polygons whose corners lie slightly outside, so that every piece has exactly the area of
// its circular sector: sizes and centroids do not depend on the number of corners.

inline double equal_area_stretch(double step_angle) {
  return std::sqrt(step_angle / std::sin(step_angle));
}

template <typename Emit>
void emit_ellipse(const Eigen::Vector2d& centre, double semi_x, double semi_y, int corners,
                  Emit&& emit) {
  const double step = 2 * std::numbers::pi / corners;
  const double stretch = equal_area_stretch(step);
  const double c = std::cos(step), s = std::sin(step);
  double x = stretch, y = 0;
  for (int k = 0; k < corners; ++k) {
    emit(Eigen::Vector2d(centre.x() + semi_x * x, centre.y() + semi_y * y));
    const double turned = c * x - s * y;
    y = s * x + c * y;
    x = turned;
  }
}

// Edges are cut into pieces because the lens bends them.
template <typename Emit>
void emit_rectangle(const Eigen::Vector2d& centre, double width, double height, int pieces,
                    Emit&& emit) {
  const Eigen::Vector2d x(0.5 * width, 0), y(0, 0.5 * height);
  const Eigen::Vector2d corner[4] = {centre - x - y, centre + x - y, centre + x + y,
                                     centre - x + y};
  for (int side = 0; side < 4; ++side) {
    const Eigen::Vector2d from = corner[side], along = corner[(side + 1) % 4] - from;
    for (int k = 0; k < pieces; ++k) emit(Eigen::Vector2d(from + along * k / pieces));
  }
}

// Whether half-bit `half` of 2 * bits is white (MARKERS.md section 2.2): a bit is 1 when its first
// half, counter-clockwise, is white.
inline bool half_bit_is_white(std::uint32_t word, int bits, int half) {
  const bool one = ((word >> (bits - 1 - half / 2)) & 1U) != 0;
  return one == (half % 2 == 0);
}

// The one outline of all white inside a WhyCode marker's black disc, in units of its radius: along
// the ring's outer rim where a half-bit is white, along its inner rim where it is black.
template <typename Emit>
void emit_code(std::uint32_t word, int bits, int corners_per_half, int pieces_per_edge,
               double radius, Emit&& emit) {
  const int halves = 2 * bits;
  const double half_angle = std::numbers::pi / bits;
  const double step = half_angle / corners_per_half;
  const double stretch = equal_area_stretch(step);
  const double c = std::cos(step), s = std::sin(step);
  const double outer = kCodeOuterRatio * radius * stretch;
  const double inner = kCodeInnerRatio * radius * stretch;
  for (int half = 0; half < halves; ++half) {
    const double start = half * half_angle;
    double x = std::cos(start), y = std::sin(start);
    const bool white = half_bit_is_white(word, bits, half);
    const bool white_before = half_bit_is_white(word, bits, (half + halves - 1) % halves);
    const double rho = white ? outer : inner;
    if (white != white_before) {
      const double from = white ? inner : outer;
      for (int k = 0; k < pieces_per_edge; ++k) {
        const double r = from + (rho - from) * k / pieces_per_edge;
        emit(Eigen::Vector2d(r * x, r * y));
      }
    }
    for (int k = 0; k < corners_per_half; ++k) {
      emit(Eigen::Vector2d(rho * x, rho * y));
      const double turned = c * x - s * y;
      y = s * x + c * y;
      x = turned;
    }
    // The arc's end, from which the next half goes on or turns along the edge.
    if (white != half_bit_is_white(word, bits, (half + 1) % halves)) {
      emit(Eigen::Vector2d(rho * x, rho * y));
    }
  }
}

}  // namespace roundel
