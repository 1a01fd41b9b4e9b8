#pragma once

#include <Eigen/Core>
#include <optional>

#include "calibration/intrinsic_parameters.hpp"
#include "core/camera_model.hpp"
#include "core/pose.hpp"

namespace roundel {

using PoseStep = Eigen::Matrix<double, 6, 1>;  // metres, then a small rotation; camera axes

// The image of a point of the board and how it moves with everything that is estimated.
struct BoardProjection {
  Eigen::Vector2d pixel;
  Eigen::Matrix<double, 2, kIntrinsicParameters> by_intrinsics;
  Eigen::Matrix<double, 2, 6> by_pose;
  Eigen::Matrix<double, 2, 3> by_place;  // of the point on the board
};

// Of a place on the board, metres, board frame. Nothing for points that are not in front of the
// camera.
std::optional<BoardProjection> project_board_point(const CameraModel& camera,
                                                   const Pose& board_in_camera,
                                                   const Eigen::Vector3d& place);

// The pixel alone.
std::optional<Eigen::Vector2d> board_pixel(const CameraModel& camera, const Pose& board_in_camera,
                                           const Eigen::Vector3d& place);

// The pose after a step.
Pose moved(const Pose& pose, const PoseStep& step);

}  // namespace roundel
