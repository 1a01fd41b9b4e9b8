#include "calibration/print_quality.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace roundel {

PrintQuality print_quality(const Board& board, std::span<const Eigen::Vector3d> offsets) {
  PrintQuality quality;
  if (offsets.size() < 4) return quality;
  // Offsets as a linear function of place: shift, turn, scale, stretch and shear in the plane, tilt
  // out of it.
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d sides = Eigen::Matrix3d::Zero();
  for (std::size_t k = 0; k < offsets.size(); ++k) {
    const Eigen::Vector3d at = board.centre_of(static_cast<int>(k) + 1).homogeneous();
    normal += at * at.transpose();
    sides += at * offsets[k].transpose();
  }
  Eigen::Matrix3d linear = normal.ldlt().solve(sides).transpose();  // offset = linear * (x, y, 1)
  if (!linear.allFinite()) return quality;
  quality.stretch = linear(1, 1) - linear(0, 0);
  // Scale and turn are not the print's fault; stretch and shear are.
  const double scale = 0.5 * (linear(0, 0) + linear(1, 1));
  const double turn = 0.5 * (linear(1, 0) - linear(0, 1));
  linear.topLeftCorner<2, 2>() << scale, -turn, turn, scale;
  double squares = 0, lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
  for (std::size_t k = 0; k < offsets.size(); ++k) {
    const Eigen::Vector3d at = board.centre_of(static_cast<int>(k) + 1).homogeneous();
    const Eigen::Vector3d rest = offsets[k] - linear * at;
    squares += rest.head<2>().squaredNorm();
    lowest = std::min(lowest, rest.z());
    highest = std::max(highest, rest.z());
  }
  quality.off_m = std::sqrt(squares / static_cast<double>(offsets.size()));
  quality.flatness_m = highest - lowest;
  return quality;
}

}  // namespace roundel
