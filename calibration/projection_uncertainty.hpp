#pragma once

#include <Eigen/Core>
#include <vector>

#include "calibration/intrinsic_parameters.hpp"
#include "core/camera_model.hpp"

namespace roundel {

// How well a calibration knows where a place of the picture looks.
struct PlaceUncertainty {
  Eigen::Vector2d pixel;
  double sigma_px = 0;  // one standard deviation of a distant point's image, along the worse axis
};

// At a grid of places over the whole picture, its corners included. A turn of the camera as a whole
// is not counted: it cannot be told from a shift of the principal point, and no user's result
// depends on it, because what is known of the camera's attitude was measured with the same
// intrinsics. Places where the lens model ends have infinite uncertainty.
std::vector<PlaceUncertainty> projection_uncertainty(const CameraModel& camera,
                                                     const IntrinsicMatrix& covariance);

}  // namespace roundel
