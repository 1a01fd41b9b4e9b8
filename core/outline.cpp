#include "core/outline.hpp"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>

#include "core/moments.hpp"

namespace roundel {

namespace {

constexpr int kPoints = 16;

const std::array<Eigen::Vector2d, kPoints>& unit_circle() {
  static const auto points = [] {
    std::array<Eigen::Vector2d, kPoints> made;
    for (int i = 0; i < kPoints; ++i) {
      const double angle = 2 * std::numbers::pi * i / kPoints;
      made[static_cast<std::size_t>(i)] = {std::cos(angle), std::sin(angle)};
    }
    return made;
  }();
  return points;
}

}  // namespace

std::optional<Ellipse> outline_of(const Pose& pose, double radius_m, const CameraModel& camera) {
  const auto centre = camera.project(pose.position);
  if (!centre) return std::nullopt;
  const Eigen::Matrix3d axes = pose.orientation.toRotationMatrix();
  const Eigen::Vector3d x = radius_m * axes.col(0), y = radius_m * axes.col(1);
  std::array<Eigen::Vector2d, kPoints> corners;  // from the centre
  for (std::size_t i = 0; i < kPoints; ++i) {
    const Eigen::Vector2d& direction = unit_circle()[i];
    const Eigen::Vector3d p = pose.position + direction.x() * x + direction.y() * y;
    if (!(p.z() > 0)) return std::nullopt;
    corners[i] = camera.to_pixel(camera.distort(p.head<2>() / p.z())) - *centre;
  }
  // Moments of the polygon, triangle by triangle.
  double area = 0, uu = 0, uv = 0, vv = 0;
  Eigen::Vector2d first = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < kPoints; ++i) {
    const Eigen::Vector2d &p = corners[i], &q = corners[i + 1 == kPoints ? 0 : i + 1];
    const double twice = p.x() * q.y() - p.y() * q.x();
    const Eigen::Vector2d sum = p + q;
    area += twice / 2;
    first += twice / 6 * sum;
    uu += twice / 24 * (p.x() * p.x() + q.x() * q.x() + sum.x() * sum.x());
    uv += twice / 24 * (p.x() * p.y() + q.x() * q.y() + sum.x() * sum.y());
    vv += twice / 24 * (p.y() * p.y() + q.y() * q.y() + sum.y() * sum.y());
  }
  if (!(std::abs(area) > 0)) return std::nullopt;
  const Eigen::Vector2d mean = first / area;
  // A polygon's variance is less than that of the ellipse around it, by as much as for a circle.
  static const double short_of = 1 - 2 / 3.0 * std::pow(std::sin(std::numbers::pi / kPoints), 2);
  const double cuu = (uu / area - mean.x() * mean.x()) / short_of;
  const double cvv = (vv / area - mean.y() * mean.y()) / short_of;
  const double cuv = (uv / area - mean.x() * mean.y()) / short_of;
  return ellipse_of(*centre + mean, cuu, cuv, cvv);
}

}  // namespace roundel
