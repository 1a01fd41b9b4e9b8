#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "calibration/board_projection.hpp"
#include "calibration/intrinsic_parameters.hpp"
#include "calibration/intrinsic_view.hpp"
#include "core/camera_model.hpp"
#include "core/pose.hpp"

namespace roundel {

// Everything that a camera calibration estimates. Invariant: one pose a view.
struct BundleState {
  CameraModel camera;
  std::vector<Eigen::Vector3d> offsets;  // of the markers by id - 1, from where the board has them,
                                         // metres, board frame; zero beyond the end
  std::vector<Pose> poses;               // board in camera
  double floor_px = 0;  // deviation that all points share beside their own; adjust() leaves it

  // Where a marker's centre is on this board.
  Eigen::Vector3d place(const BoardPoint& point) const;
  // Covariance of where it was seen.
  Eigen::Matrix2d spread(const BoardPoint& point) const {
    return point.covariance + floor_px * floor_px * Eigen::Matrix2d::Identity();
  }
};

struct BundleOptions {
  IntrinsicMask estimated{};  // what is not stays as it is
  int markers = 0;            // whose offsets are estimated: ids up to this
  Eigen::Vector3d offset_sigma_m = Eigen::Vector3d::Ones();  // what is known of them beforehand
  double residual_sigma = 1;  // of whitened residuals; what the prior is weighed against
  double robust_scale = 0;  // whitened residuals beyond it count linearly; 0: all by their squares
  int max_steps = 60;
};

struct BundleResult {
  BundleState state;
  double cost = 0;       // half the sum of the squared whitened residuals (robust), prior included
  double data_cost = 0;  // without the prior
  bool converged = false;  // the last step changed next to nothing
  // Of the intrinsics with all else free, if whitened residuals have the deviation residual_sigma;
  // zero for what is not estimated.
  IntrinsicMatrix covariance = IntrinsicMatrix::Zero();
  double unknowns = 0;  // that the data determine; those that the prior holds count in part
};

// Levenberg-Marquardt over intrinsics, board and board poses together. The poses' blocks are
// eliminated, so a step costs time in proportion to the number of views.
// views.size() == start.poses.size().
BundleResult adjust(std::span<const BoardView> views, const BundleState& start,
                    const BundleOptions& options);

// Length of a point's residual in its own standard deviations; infinite where it does not project.
double whitened_residual(const BoardPoint& point, const BundleState& state,
                         const Pose& board_in_camera);

}  // namespace roundel
