#include "calibration/arena_map.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "calibration/arena_pose_fit.hpp"

namespace roundel {
namespace {

Eigen::Vector2d ray_of(const Eigen::Vector3d& in_camera) {
  return in_camera.head<2>() / in_camera.z();
}

// A marker's deviation across the ray to it, metres. The published ones go along the camera's axes,
// and off the optical axis the large one along the ray shows up in all three: what lies across
// can't be read off them. But both come from the same outline: what shifts a circle's image by one
// pixel changes its radius, and so the distance, by less than a pixel; the rest is what the radius
// has to share with the edge shift (measured in the simulator).
double deviation_across(const Marker& marker, double focal_length) {
  constexpr double kShare = 0.5;
  const double radius = marker.ellipse.a / focal_length;  // over the distance
  const double share = kShare * radius * radius;          // of the variance along the ray
  return std::sqrt(share / (1 + 2 * share) * marker.sigma_position.squaredNorm());
}

double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

void take_off(const MarkerMount& mount, ArenaPose& pose, double marker_heading) {
  pose.heading = std::remainder(marker_heading - mount.rotation, 2 * std::numbers::pi);
  if (pose.heading <= -std::numbers::pi) pose.heading = std::numbers::pi;
  const double c = std::cos(pose.heading), s = std::sin(pose.heading);
  pose.position.x() -= c * mount.offset_x_m - s * mount.offset_y_m;
  pose.position.y() -= s * mount.offset_x_m + c * mount.offset_y_m;
  // The arm turns with the heading.
  const double arm = std::hypot(mount.offset_x_m, mount.offset_y_m) * pose.sigma_heading;
  pose.sigma_position.x() = std::hypot(pose.sigma_position.x(), arm);
  pose.sigma_position.y() = std::hypot(pose.sigma_position.y(), arm);
}

}  // namespace

ArenaMap::ArenaMap(const ArenaCalibration& calibration, ArenaMode mode, const MarkerMounts& mounts)
    : arena_in_camera_(calibration.arena_in_camera),
      covariance_(calibration.covariance),
      focal_length_(std::sqrt(calibration.camera.intrinsics.fx * calibration.camera.intrinsics.fy)),
      mode_(mode),
      usual_(mounts.usual) {
  for (const IdMount& entry : mounts.by_id) {
    const auto id = static_cast<std::size_t>(std::max(0, entry.id));
    if (by_id_.size() <= id) by_id_.resize(id + 1, usual_);
    by_id_[id] = entry.mount;
  }
  for (const ArenaReference& reference : calibration.references) {
    fixed_.push_back({reference.pixel, reference.place.z()});
  }
}

const MarkerMount& ArenaMap::mount_of(int id) const {
  const auto index = static_cast<std::size_t>(id);
  return id >= 0 && index < by_id_.size() ? by_id_[index] : usual_;
}

// The height of a corner marker or anchor, if it is one: they lie on the floor, not on robots.
std::optional<double> ArenaMap::fixed_height(const Marker& marker) const {
  constexpr double kSamePlace = 3;  // pixels
  const Eigen::Vector2d pixel(marker.u, marker.v);
  for (const FixedPixel& fixed : fixed_) {
    if ((fixed.pixel - pixel).squaredNorm() < kSamePlace * kSamePlace) return fixed.height_m;
  }
  return std::nullopt;
}

// Of the two poses, the one that lies flat on the floor; the picture's opinion counts where both
// nearly do.
const Pose& ArenaMap::pose_on_floor(const Marker& marker) const {
  constexpr double kTilt = 0.05;       // radians, by which a robot's marker may lean
  constexpr double kMostOpinion = 10;  // of the picture, natural logarithm of odds
  if (!marker.has_alternative) return marker.pose;
  const Eigen::Vector3d up = arena_in_camera_.normal();
  const double tilt = angle_between(marker.pose.normal(), up);
  const double other = angle_between(marker.alternative.normal(), up);
  const double opinion = std::min(kMostOpinion, -std::log(std::max(marker.ambiguity, 1e-9)));
  const double floor_says = (tilt * tilt - other * other) / (2 * kTilt * kTilt);
  return floor_says > opinion ? marker.alternative : marker.pose;
}

ArenaPose ArenaMap::locate_on_floor(const Marker& marker, const MarkerMount& mount) const {
  ArenaPose result;
  const Pose& pose = pose_on_floor(marker);
  const std::optional<double> fixed = fixed_height(marker);
  const double height = fixed ? *fixed : mount.height_m;
  const auto point = on_plane(arena_in_camera_, ray_of(pose.position), height);
  if (!point) return result;
  result.valid = true;
  result.position = *point;

  const PointSensitivity image = point_sensitivity(arena_in_camera_, *point);
  const Eigen::Matrix2d to_floor = image.by_floor.inverse();
  const double distance = arena_in_camera_.to_camera(*point).norm();
  const double across = deviation_across(marker, focal_length_) * distance / pose.position.norm();
  const Eigen::Matrix2d seen = across * across * image.by_camera * image.by_camera.transpose() +
                               image.by_pose * covariance_ * image.by_pose.transpose();
  const Eigen::Matrix2d on_floor = to_floor * seen * to_floor.transpose();
  result.sigma_position = {std::sqrt(on_floor(0, 0)), std::sqrt(on_floor(1, 1)), 0};

  result.sigma_heading = std::numbers::pi;
  if (marker.id < 0) return result;
  // What was measured is the image: the ends of the marker's axes are taken from it to the plane
  // where they are known to lie. Errors of the pose that the image does not show drop out.
  const double arm = 0.02 * distance;
  std::array<Eigen::Vector2d, 2> sides;
  for (int axis = 0; axis < 2; ++axis) {
    const Eigen::Vector3d end = arm * Eigen::Vector3d::Unit(axis);
    const auto one = on_plane(arena_in_camera_, ray_of(pose.to_camera(end)), height);
    const auto other = on_plane(arena_in_camera_, ray_of(pose.to_camera(-end)), height);
    if (!one || !other) return result;
    sides[static_cast<std::size_t>(axis)] = (*one - *other).head<2>();
  }
  const double heading = std::atan2(sides[0].y() - sides[1].x(), sides[0].x() + sides[1].y());
  const Eigen::Vector3d up = arena_in_camera_.normal();
  const Eigen::Vector3d turn = marker.sigma_rotation.cwiseAbs2();
  result.sigma_heading = std::min(
      std::numbers::pi,
      std::sqrt(up.cwiseAbs2().dot(turn) + up.dot(covariance_.bottomRightCorner<3, 3>() * up)));
  if (fixed) {
    result.heading = heading;
  } else {
    take_off(mount, result, heading);
  }
  return result;
}

ArenaPose ArenaMap::locate_in_space(const Marker& marker) const {
  ArenaPose result;
  result.valid = true;
  const Eigen::Quaterniond to_arena = arena_in_camera_.orientation.conjugate();
  const Eigen::Vector3d arm = marker.pose.position - arena_in_camera_.position;
  result.position = to_arena * arm;

  // The marker's own deviations, then those of the arena.
  Eigen::Matrix3d covariance = marker.sigma_position.cwiseAbs2().asDiagonal();
  Eigen::Matrix<double, 3, 6> by_arena;
  by_arena << -Eigen::Matrix3d::Identity(), Eigen::Matrix3d::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    by_arena.col(3 + axis) = arm.cross(Eigen::Vector3d::Unit(axis));
  }
  covariance += by_arena * covariance_ * by_arena.transpose();
  const Eigen::Matrix3d axes = to_arena.toRotationMatrix();
  result.sigma_position = (axes * covariance * axes.transpose()).diagonal().cwiseSqrt();

  result.sigma_heading = std::numbers::pi;
  if (marker.id < 0) return result;
  const Eigen::Vector3d x = to_arena * (marker.pose.orientation * Eigen::Vector3d::UnitX());
  const Eigen::Vector3d up = arena_in_camera_.normal();
  result.sigma_heading =
      std::min(std::numbers::pi, std::sqrt(up.cwiseAbs2().dot(marker.sigma_rotation.cwiseAbs2()) +
                                           up.dot(covariance_.bottomRightCorner<3, 3>() * up)) /
                                     std::max(x.head<2>().norm(), 1e-6));
  // The offset in 3D: taken off in the marker's plane, with the marker's tilt.
  const MarkerMount& mount = mount_of(marker.id);
  const double c = std::cos(mount.rotation), s = std::sin(mount.rotation);
  const Eigen::Vector3d offset(c * mount.offset_x_m + s * mount.offset_y_m,
                               c * mount.offset_y_m - s * mount.offset_x_m, 0);
  result.position -= to_arena * (marker.pose.orientation * offset);
  MarkerMount turn_only;
  turn_only.rotation = mount.rotation;
  take_off(turn_only, result, std::atan2(x.y(), x.x()));
  return result;
}

ArenaPose ArenaMap::locate(const Marker& marker) const {
  if (!marker.has_pose || !(marker.pose.position.z() > 0)) return {};
  return mode_ == ArenaMode::k3D ? locate_in_space(marker)
                                 : locate_on_floor(marker, mount_of(marker.id));
}

}  // namespace roundel
