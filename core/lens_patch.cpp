#include "core/lens_patch.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace roundel {

std::optional<LensPatch> LensPatch::make(const CameraModel& camera, const Eigen::Vector2d& middle,
                                         double reach) {
  // Least squares over a 4 x 4 grid; the grid is the same for every patch, so is its
  // pseudo-inverse.
  constexpr int kSide = 4;
  constexpr int kPoints = kSide * kSide;
  const auto grid = [](int i) {
    const int column = i % kSide, row = i / kSide;
    return Eigen::Vector2d(column / 1.5 - 1, row / 1.5 - 1);
  };
  using Design = Eigen::Matrix<double, kPoints, kTerms>;
  static const Design solver = [&grid] {
    Design design;
    for (int i = 0; i < kPoints; ++i) {
      const double x = grid(i).x(), y = grid(i).y();
      design.row(i) << 1, x, y, x * x, x * y, y * y, x * x * x, x * x * y, x * y * y, y * y * y;
    }
    const Eigen::Matrix<double, kTerms, kTerms> normal_matrix = design.transpose() * design;
    return Design(design * normal_matrix.inverse());
  }();

  LensPatch patch;
  patch.middle_ = middle;
  patch.scale_ = 1 / std::max(reach, 1.0);
  const auto at_middle = camera.normalise(middle);
  if (!at_middle) return std::nullopt;
  const Eigen::Matrix2d slope = camera.distort_jacobian(*at_middle).inverse();
  const Eigen::Vector2d seen = camera.distort(*at_middle);
  CameraModel::Points<CameraModel::Sixteen> wanted{}, points{};
  for (int i = 0; i < kPoints; ++i) {
    const Eigen::Vector2d at = camera.from_pixel(middle + grid(i) / patch.scale_);
    const Eigen::Vector2d guess = *at_middle + slope * (at - seen);
    wanted.x[i] = at.x();
    wanted.y[i] = at.y();
    points.x[i] = guess.x();
    points.y[i] = guess.y();
  }
  if (!camera.undistort(wanted, points)) return std::nullopt;
  const Eigen::Map<const Eigen::Matrix<double, kPoints, 1>> x(
      reinterpret_cast<const double*>(&points.x)),
      y(reinterpret_cast<const double*>(&points.y));
  for (int term = 0; term < kTerms; ++term) {
    patch.coefficients_(0, term) = solver.col(term).dot(x);
    patch.coefficients_(1, term) = solver.col(term).dot(y);
  }
  return patch;
}

std::array<Cubic, 2> LensPatch::cubic() const {
  std::array<Cubic, 2> cubic{};
  const std::array<double, 4> power = {1, scale_, scale_ * scale_, scale_ * scale_ * scale_};
  constexpr std::array<std::size_t, kTerms - 1> kOrder = {1, 1, 2, 2, 2, 3, 3, 3, 3};
  for (int axis = 0; axis < 2; ++axis) {
    for (int term = 1; term < kTerms; ++term) {
      const auto k = static_cast<std::size_t>(term - 1);
      cubic[static_cast<std::size_t>(axis)][k] =
          static_cast<float>(coefficients_(axis, term) * power[kOrder[k]]);
    }
  }
  return cubic;
}

}  // namespace roundel
