#pragma once

#include <Eigen/Core>
#include <span>

namespace roundel {

// How far a point is from where it should be, and what its own noise would make of that.
struct NoisyResidual {
  Eigen::Vector2d pixels;
  Eigen::Matrix2d covariance;  // pixels squared, positive definite; its size need not be right
};

// What all points share beside their own noise (print, paper, the camera's processing): the
// standard deviation, in pixels, with which residuals of covariance s^2 (C + floor^2 I) are
// likeliest, for the best s. 0 unless the residuals speak clearly for more, up to 1.
double noise_floor(std::span<const NoisyResidual> residuals);

}  // namespace roundel
