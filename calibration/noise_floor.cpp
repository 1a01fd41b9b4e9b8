#include "calibration/noise_floor.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace roundel {
namespace {

// Twice the negative logarithm of the likelihood, for the best scale; lower is likelier.
double unlikelihood(std::span<const NoisyResidual> residuals, double floor_px) {
  const Eigen::Matrix2d floor = floor_px * floor_px * Eigen::Matrix2d::Identity();
  double logarithms = 0, squares = 0;
  for (const NoisyResidual& residual : residuals) {
    const Eigen::Matrix2d covariance = residual.covariance + floor;
    logarithms += std::log(covariance.determinant());
    squares += residual.pixels.dot(covariance.inverse() * residual.pixels);
  }
  constexpr double kLeast = 1e-30;  // without any noise, in tests
  const double values = 2 * static_cast<double>(residuals.size());
  return logarithms + values * std::log(std::max(kLeast, squares / values));
}

}  // namespace

double noise_floor(std::span<const NoisyResidual> residuals) {
  constexpr double kLeastPx = 1e-4, kStep = 1.15;  // finer makes no difference
  constexpr int kSteps = 66;                       // to 1 px
  constexpr double kClearly = 4;                   // two deviations
  if (residuals.empty()) return 0;
  double best = 0, least = unlikelihood(residuals, 0) - kClearly;
  double floor_px = kLeastPx;
  for (int step = 0; step < kSteps; ++step, floor_px *= kStep) {
    const double here = unlikelihood(residuals, floor_px);
    if (here >= least) continue;
    least = here;
    best = floor_px;
  }
  return best;
}

}  // namespace roundel
