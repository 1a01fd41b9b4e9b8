#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "core/pose.hpp"

namespace roundel {

// A point of a plane and where it was seen.
struct PlanePoint {
  Eigen::Vector2d on_plane;  // metres
  Eigen::Vector2d seen;      // pixels, or normalised coordinates
};

// The projective map from the plane to what was seen, least squares by the normalised direct linear
// transform, so that seen ~ H (x, y, 1). Nothing for fewer than four points or points on a line.
std::optional<Eigen::Matrix3d> fit_homography(std::span<const PlanePoint> points);

// Where the homography sees a point of the plane; not finite where that is at infinity.
Eigen::Vector2d apply(const Eigen::Matrix3d& homography, const Eigen::Vector2d& on_plane);

// Which of the points lie where most of them say that they should, within `tolerance` (in units of
// `seen`): the largest consensus of four-point homographies, drawn in a fixed order. Fewer than
// four true values mean that there is none.
std::vector<bool> consensus(std::span<const PlanePoint> points, double tolerance);

// The plane's pose (its z toward the camera's side) from a homography to normalised coordinates
// without lens distortion. Nothing if the plane would be behind the camera.
std::optional<Pose> pose_from_homography(const Eigen::Matrix3d& homography);

}  // namespace roundel
