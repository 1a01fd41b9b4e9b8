#include "core/camera_model.hpp"

#include <Eigen/LU>
#include <cmath>

namespace roundel {

Eigen::Vector2d CameraModel::distort(const Eigen::Vector2d& normalised) const {
  const auto& [k1, k2, p1, p2, k3] = distortion;
  const double x = normalised.x(), y = normalised.y();
  const double r2 = x * x + y * y;
  const double radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
  return {x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
          y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y};
}

Eigen::Matrix2d CameraModel::distort_jacobian(const Eigen::Vector2d& normalised) const {
  const auto& [k1, k2, p1, p2, k3] = distortion;
  const double x = normalised.x(), y = normalised.y();
  const double r2 = x * x + y * y;
  const double radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
  const double radial_slope = k1 + r2 * (2 * k2 + r2 * 3 * k3);  // d(radial)/d(r2)
  const double cross = 2 * x * y * radial_slope + 2 * p1 * x + 2 * p2 * y;
  Eigen::Matrix2d jacobian;
  jacobian << radial + 2 * x * x * radial_slope + 2 * p1 * y + 6 * p2 * x, cross,  //
      cross, radial + 2 * y * y * radial_slope + 6 * p1 * y + 2 * p2 * x;
  return jacobian;
}

namespace {

// On the branch of the lens model that contains the optical axis, radii grow with the angle; beyond
// its fold a second, false point of the scene would have the same image.
bool before_fold(const Distortion& d, double r2) {
  // d(r * radial)/dr as a polynomial in r2. It is 1 on the axis; the first fold is its first root.
  // Signs at a few radii are enough: a lens polynomial has at most three roots in r2.
  constexpr int kSteps = 8;
  for (int step = 1; step <= kSteps; ++step) {
    const double s = r2 * step / kSteps;
    if (1 + s * (3 * d.k1 + s * (5 * d.k2 + s * 7 * d.k3)) <= 0) return false;
  }
  return true;
}

}  // namespace

std::optional<Eigen::Vector2d> CameraModel::undistort(const Eigen::Vector2d& distorted) const {
  constexpr int kMaxSteps = 30;
  constexpr double kTolerance = 1e-13;
  Eigen::Vector2d x = distorted;
  // Far out, Newton from the distorted point can leap over the fold: step lengths are limited.
  for (int step = 0; step < kMaxSteps; ++step) {
    const Eigen::Vector2d error = distort(x) - distorted;
    const Eigen::Matrix2d jacobian = distort_jacobian(x);
    if (!(jacobian.determinant() > 1e-9)) return std::nullopt;
    Eigen::Vector2d change = jacobian.inverse() * error;
    const double limit = 0.5 * (x.norm() + 0.1);
    if (change.norm() > limit) change *= limit / change.norm();
    x -= change;
    if (!x.allFinite()) return std::nullopt;
    if (change.norm() < kTolerance * (1 + x.norm())) {
      if (!before_fold(distortion, x.squaredNorm())) return std::nullopt;
      return x;
    }
  }
  return std::nullopt;
}

std::optional<Eigen::Vector2d> CameraModel::undistort(const Eigen::Vector2d& distorted,
                                                      const Eigen::Vector2d& guess) const {
  constexpr int kMaxSteps = 6;
  constexpr double kTolerance =
      3e-5;  // of the step before the last one: the next leaves its square
  Eigen::Vector2d x = guess;
  for (int step = 0; step < kMaxSteps; ++step) {
    const Eigen::Matrix2d jacobian = distort_jacobian(x);
    if (!(jacobian.determinant() > 1e-9)) return std::nullopt;
    const Eigen::Vector2d change = jacobian.inverse() * (distort(x) - distorted);
    x -= change;
    if (change.norm() < kTolerance) {
      if (!before_fold(distortion, x.squaredNorm())) return std::nullopt;
      return x;
    }
  }
  return std::nullopt;
}

std::optional<Eigen::Vector2d> CameraModel::normalise(const Eigen::Vector2d& pixel) const {
  return undistort(from_pixel(pixel));
}

std::optional<Eigen::Vector2d> CameraModel::project(const Eigen::Vector3d& in_camera) const {
  if (!(in_camera.z() > 0)) return std::nullopt;
  const Eigen::Vector2d normalised = in_camera.head<2>() / in_camera.z();
  if (!before_fold(distortion, normalised.squaredNorm())) return std::nullopt;
  return to_pixel(distort(normalised));
}

}  // namespace roundel
