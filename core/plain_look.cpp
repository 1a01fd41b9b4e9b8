#include "core/plain_look.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/bilinear.hpp"
#include "core/rounding.hpp"

namespace roundel {

namespace {

constexpr int kDirections = 48;
constexpr double kMarginRadius = 1.16;  // inside the printed white margin
constexpr double kOtherGrey = 0.35;  // share of the contrast: more than noise and slopes of light
// The margin is looked at where the rim is so far away that its blur does not reach there.
constexpr double kMinGapPx = 1.5, kGapBlurs = 2;

struct Circle {
  double squares = 0;  // of differences between neighbours
  int off = 0, seen = 0, pairs = 0;
  double off_share() const { return seen > 0 ? double(off) / seen : 0; }
  double noise() const { return pairs > 0 ? std::sqrt(squares / (2 * pairs)) : 0; }
};

Circle look_along(const LumaView& frame, const PlaneProjection& projection, double radius,
                  double gap_px, double level, double tolerance) {
  Circle circle;
  double before = 0;
  bool has_before = false;
  for (int i = 0; i < kDirections; ++i) {
    const double angle = 2 * std::numbers::pi * i / kDirections;
    const double x = std::cos(angle), y = std::sin(angle);
    const Eigen::Vector2d p = projection.pixel(radius * x, radius * y);
    const bool clear = (p - projection.pixel(x, y)).squaredNorm() >= gap_px * gap_px;
    const int u = nearest_int(p.x()), v = nearest_int(p.y());
    if (!clear || !frame.contains(u, v)) {
      has_before = false;
      continue;
    }
    const double grey = frame.at(u, v);
    ++circle.seen;
    circle.off += std::abs(grey - level) > tolerance;
    if (has_before) {
      circle.squares += (grey - before) * (grey - before);
      ++circle.pairs;
    }
    before = grey;
    has_before = true;
  }
  return circle;
}

}  // namespace

Surroundings look_around(const LumaView& frame, const PlaneProjection& projection,
                         double inner_ratio, double blur_px, const Levels& levels) {
  const double tolerance = kOtherGrey * levels.contrast();
  const Circle margin =
      look_along(frame, projection, kMarginRadius, std::max(kMinGapPx, kGapBlurs * blur_px),
                 levels.bright, tolerance);
  Surroundings around;
  around.margin_off = margin.off_share();
  around.noise = margin.noise();
  if (inner_ratio > 0) {
    const Circle ring =
        look_along(frame, projection, (1 + inner_ratio) / 2, 0, levels.dark, tolerance);
    around.ring_off = ring.off_share();
    around.noise = ring.noise();
  }
  return around;
}

}  // namespace roundel
