#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "calibration/intrinsic_parameters.hpp"
#include "calibration/intrinsic_view.hpp"
#include "core/camera_model.hpp"
#include "core/pose.hpp"

namespace roundel {

struct IntrinsicOptions {
  bool estimate_k3 = true;
  // The board is flat and its markers lie exactly where they should. Otherwise every marker's place
  // is estimated too, near where it should be: paper is not flat, and printers are off by tenths of
  // a millimetre, which is far more than the camera's noise.
  bool exact_board = false;
  double spacing_m = 0.04;  // of the board: what tenths of a millimetre are measured against
};

// One view after the adjustment.
struct ViewResult {
  int picture = 0;      // BoardView::picture
  int points = 0;       // used
  int outliers = 0;     // left out
  double error_px = 0;  // root mean square distance of the points used from where they should be
  double tilt = 0;      // of the board against the picture, radians
  Pose board_in_camera;
};

struct IntrinsicCalibration {
  CameraModel camera;
  std::vector<Eigen::Vector3d> offsets;  // of the markers by id - 1, metres, board frame; none
                                         // if the board is exact
  IntrinsicMatrix covariance = IntrinsicMatrix::Zero();
  double error_px = 0;  // root mean square over the points of all views: "total error"
  // Of the residuals: their own noise as stated times residual_sigma, and beside it floor_px, which
  // all points share.
  double residual_sigma = 0, floor_px = 0;
  double worst_px = 0;  // one standard deviation of where the camera sees a point, at the worst
                        // place of the picture (projection_uncertainty.hpp)
  int points = 0, outliers = 0;
  std::vector<ViewResult> views;

  IntrinsicVector sigma() const { return covariance.diagonal().cwiseSqrt(); }
};

// Fewer views can't tell a wrong one from a right one; some 15 are good.
inline constexpr int kMinViews = 5;

// Intrinsics from views of the board: start values from homographies, bundle adjustment over all
// views with a robust loss, outliers left out. `start` is used if given. Throws std::runtime_error
// with a sentence for the user if the views do not determine the camera.
IntrinsicCalibration calibrate_intrinsics(std::span<const BoardView> views, int width, int height,
                                          const IntrinsicOptions& options,
                                          const std::optional<CameraModel>& start = std::nullopt);

}  // namespace roundel
