#include "bench/common/placement.hpp"

#include <algorithm>
#include <cmath>

#include "simulator/visibility.hpp"

namespace roundel::bench {

namespace {

constexpr double kBorder = 3;  // pixels that stay free for blur

}  // namespace

Eigen::Quaterniond tilted(double tilt, double axis_angle, double turn) {
  const Eigen::Vector3d axis(std::cos(axis_angle), std::sin(axis_angle), 0);
  return with_positive_w(Eigen::Quaterniond(Eigen::AngleAxisd(tilt, axis)) * facing_camera() *
                         Eigen::Quaterniond(Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ())));
}

double incidence(const Pose& pose) {
  return std::acos(std::clamp(-pose.normal().dot(pose.position.normalized()), -1.0, 1.0));
}

double short_side_px(const CameraModel& camera, const Pose& pose, double diameter_m) {
  return std::min(camera.fx, camera.fy) * diameter_m / pose.position.norm() *
         std::cos(incidence(pose));
}

bool plate_in_picture(const CameraModel& camera, const Pose& pose, double plate_side_m) {
  return inside_image(disc_outline(camera, pose, plate_side_m * std::sqrt(0.5)), camera.width,
                      camera.height, kBorder);
}

}  // namespace roundel::bench
