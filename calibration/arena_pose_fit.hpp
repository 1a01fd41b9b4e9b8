#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "core/covariance.hpp"
#include "core/pose.hpp"

namespace roundel {

// A fixed point of the arena and where the camera sees it.
struct PlacedRay {
  Eigen::Vector3d place;        // arena frame, metres
  Eigen::Vector2d seen;         // normalised, lens removed
  Eigen::Matrix2d information;  // inverse covariance of `seen`
};

// The arena frame in the camera frame.
struct ArenaPoseFit {
  Pose arena_in_camera;
  PoseCovariance covariance;  // from the rays' covariances alone: position, then rotation
  double chi_square = 0;      // of the weighted residuals, with 2 n - 6 degrees of freedom
};

// The pose that explains at least four rays best: by homography, then weighted least squares on
// the rays. The rectangle's known size takes the place of the markers' own distances, which gamma
// and ink falsify. Nothing for points (nearly) on a line, or if the camera would be below the
// floor.
std::optional<ArenaPoseFit> fit_arena_pose(std::span<const PlacedRay> rays);

// Where a ray (normalised) meets the plane z = height of the arena. Nothing if it does not, in
// front of the camera and less flat than about one degree.
std::optional<Eigen::Vector3d> on_plane(const Pose& arena_in_camera, const Eigen::Vector2d& seen,
                                        double height_m);

// How the image of an arena point moves: the derivative of its normalised coordinates.
struct PointSensitivity {
  Eigen::Matrix2d by_floor;               // by its x and y in the arena
  Eigen::Matrix<double, 2, 6> by_pose;    // by the arena's position and rotation, camera axes
  Eigen::Matrix<double, 2, 3> by_camera;  // by the point in camera axes
};
PointSensitivity point_sensitivity(const Pose& arena_in_camera, const Eigen::Vector3d& place);

// What the covariance of a pose makes of a position found on the arena's plane there: 2x2, square
// metres, arena axes.
Eigen::Matrix2d floor_covariance(const Pose& arena_in_camera, const PoseCovariance& covariance,
                                 const Eigen::Vector3d& place);

}  // namespace roundel
