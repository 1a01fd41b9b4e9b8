#pragma once

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
  double stretch = 0;
  std::vector<Pose> poses;  // board in camera
};

struct BundleOptions {
  IntrinsicMask estimated{};  // what is not stays as it is
  double robust_scale = 0;   // whitened residuals beyond it count linearly; 0: all by their squares
  double stretch_sigma = 0;  // what is known of the print beforehand, one standard deviation
  double residual_sigma = 1;  // of whitened residuals; what the prior is weighed against
  int max_steps = 60;
};

struct BundleResult {
  BundleState state;
  double cost = 0;         // half the sum of the squared whitened residuals, robust
  bool converged = false;  // the last step changed next to nothing
  // Of the estimated parameters with the poses free, if whitened residuals have the deviation
  // residual_sigma; zero for what is not estimated.
  IntrinsicMatrix covariance = IntrinsicMatrix::Zero();
};

// Levenberg-Marquardt over intrinsics and board poses together. The poses' blocks are eliminated,
// so a step costs time in proportion to the number of views. views.size() == state.poses.size().
BundleResult adjust(std::span<const BoardView> views, const BundleState& start,
                    const BundleOptions& options);

// Length of a point's residual in its own standard deviations; infinite where it does not project.
double whitened_residual(const BoardPoint& point, const CameraModel& camera, double stretch,
                         const Pose& board_in_camera);

}  // namespace roundel
