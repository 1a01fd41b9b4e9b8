#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>

#include "core/camera_model.hpp"
#include "core/marker.hpp"
#include "core/pose.hpp"

namespace roundel {

// A conic in normalised image coordinates: points x = (x, y, 1) with x' Q x = 0. Symmetric 3x3.
using Conic = Eigen::Matrix3d;

// Where a circle may lie in space: its centre (metres) and the unit normal of its printed face, in
// the camera frame, normal . centre < 0.
struct CirclePose {
  Eigen::Vector3d centre;
  Eigen::Vector3d normal;
};

// The conic through the undistorted points of an ellipse in the image. The lens bends the outline,
// so points all around are undistorted one by one and the conic is fitted to them (METHOD.md
// section 2). Nothing where the lens model has no inverse.
std::optional<Conic> undistorted_conic(const Ellipse& ellipse, const CameraModel& camera);

// Least-squares conic through normalised points (at least five, around an ellipse).
std::optional<Conic> fit_conic(std::span<const Eigen::Vector2d> points);

// The two poses of a circle of the given radius (metres) whose outline is the conic ([P] eqs 1, 2
// with the normal's misprint corrected; METHOD.md section 3). They coincide when the circle is seen
// frontally. Nothing for conics that are no ellipse in front of the camera.
std::optional<std::array<CirclePose, 2>> circle_poses(const Conic& conic, double radius_m);

// The other pose that a circle's outline allows, seen from far: mirrored in the plane across the
// line of sight. Good to a few percent of the radius over the distance, which does for an
// alternative.
Pose mirrored_pose(const Pose& pose);

}  // namespace roundel
