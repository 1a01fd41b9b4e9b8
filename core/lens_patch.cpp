#include "core/lens_patch.hpp"

#include <Eigen/LU>
#include <algorithm>

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
  static const Eigen::Matrix<double, kTerms, kPoints> solver = [&grid] {
    Design design;
    for (int i = 0; i < kPoints; ++i) {
      const double x = grid(i).x(), y = grid(i).y();
      design.row(i) << 1, x, y, x * x, x * y, y * y, x * x * x, x * x * y, x * y * y, y * y * y;
    }
    const Eigen::Matrix<double, kTerms, kTerms> normal_matrix = design.transpose() * design;
    return Eigen::Matrix<double, kTerms, kPoints>(normal_matrix.inverse() * design.transpose());
  }();

  LensPatch patch;
  patch.middle_ = middle;
  patch.scale_ = 1 / std::max(reach, 1.0);
  Eigen::Matrix<double, 2, kPoints> points;
  for (int i = 0; i < kPoints; ++i) {
    const auto point = camera.normalise(middle + grid(i) / patch.scale_);
    if (!point) return std::nullopt;
    points.col(i) = *point;
  }
  patch.coefficients_.noalias() = points * solver.transpose();
  return patch;
}

Eigen::Matrix<double, 2, 4> LensPatch::row(double dv) const {
  const double y = dv * scale_, s = scale_;
  const auto& c = coefficients_;  // of 1, x, y, xx, xy, yy, xxx, xxy, xyy, yyy
  Eigen::Matrix<double, 2, 4> row;
  row.col(0) = c.col(0) + y * (c.col(2) + y * (c.col(5) + y * c.col(9)));
  row.col(1) = s * (c.col(1) + y * (c.col(4) + y * c.col(8)));
  row.col(2) = s * s * (c.col(3) + y * c.col(7));
  row.col(3) = s * s * s * c.col(6);
  return row;
}

}  // namespace roundel
