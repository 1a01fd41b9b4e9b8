#include "calibration/edge_width.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "core/bilinear.hpp"

namespace roundel {
namespace {

// Distance between a quarter and three quarters of the way from dark to bright, doubled, along a
// line from `from` (dark) to `to` (bright).
std::optional<double> width_along(const LumaView& frame, const Eigen::Vector2d& from,
                                  const Eigen::Vector2d& to, const Levels& levels) {
  if (!can_interpolate(frame, from.x(), from.y()) || !can_interpolate(frame, to.x(), to.y()))
    return std::nullopt;
  constexpr double kStep = 0.25;  // pixels
  const double length = (to - from).norm();
  const int steps = static_cast<int>(length / kStep);
  const double low = levels.dark + 0.25 * levels.contrast();
  const double high = levels.dark + 0.75 * levels.contrast();
  double last_low = -1;
  for (int i = 0; i <= steps; ++i) {
    const Eigen::Vector2d at = from + (to - from) * (i * kStep / length);
    const double grey = interpolate(frame, at.x(), at.y());
    if (grey < low) last_low = i * kStep;
    if (grey > high && last_low >= 0) return 2 * (i * kStep - last_low);
  }
  return std::nullopt;
}

}  // namespace

void EdgeWidths::add(const LumaView& frame, const Ellipse& ellipse, const Levels& levels) {
  constexpr int kPoints = 32;
  constexpr double kReach = 0.3;  // of the smaller semi-axis: within the ring, within the margin
  const Eigen::Rotation2Dd turn(ellipse.angle);
  for (int i = 0; i < kPoints; ++i) {
    const double t = 2 * std::numbers::pi * i / kPoints;
    const Eigen::Vector2d rim(ellipse.a * std::cos(t), ellipse.b * std::sin(t));
    const Eigen::Vector2d across =
        turn * Eigen::Vector2d(std::cos(t) / ellipse.a, std::sin(t) / ellipse.b).normalized();
    const Eigen::Vector2d at = Eigen::Vector2d(ellipse.u, ellipse.v) + turn * rim;
    const double reach = kReach * ellipse.b;
    const auto width = width_along(frame, at - reach * across, at + reach * across, levels);
    if (!width) continue;
    const double half_turns = std::atan2(across.y(), across.x()) / std::numbers::pi + 1;
    const auto direction =
        static_cast<std::size_t>(std::lround(half_turns * kDirections)) % kDirections;
    sums_[direction] += *width;
    ++counts_[direction];
  }
}

double EdgeWidths::worst() const {
  double worst = 0;
  for (std::size_t i = 0; i < kDirections; ++i) {
    if (counts_[i] > 0) worst = std::max(worst, sums_[i] / counts_[i]);
  }
  return worst > 0 ? worst : std::numeric_limits<double>::infinity();
}

}  // namespace roundel
