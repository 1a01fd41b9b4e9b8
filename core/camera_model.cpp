#include "core/camera_model.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace roundel {

namespace {

// A lens's effect on a point, or on several at a time, and its derivative, which is symmetric.
template <typename Number>
struct Distorted {
  Number x, y;
  Number xx, xy, yy;
};

template <typename Number>
inline Distorted<Number> distorted(const Distortion& d, const Number& x, const Number& y) {
  const Number x2 = x * x, y2 = y * y, xy = x * y;
  const Number r2 = x2 + y2;
  const Number radial = 1 + r2 * (d.k1 + r2 * (d.k2 + r2 * d.k3));
  const Number slope = 2 * (d.k1 + r2 * (2 * d.k2 + r2 * (3 * d.k3)));  // 2 d(radial)/d(r2)
  return {x * radial + 2 * d.p1 * xy + d.p2 * (r2 + 2 * x2),
          y * radial + d.p1 * (r2 + 2 * y2) + 2 * d.p2 * xy,
          radial + x2 * slope + 2 * d.p1 * y + 6 * d.p2 * x,
          xy * slope + 2 * d.p1 * x + 2 * d.p2 * y,
          radial + y2 * slope + 6 * d.p1 * y + 2 * d.p2 * x};
}

}  // namespace

Eigen::Vector2d CameraModel::distort(const Eigen::Vector2d& normalised) const {
  const auto d = distorted(distortion, normalised.x(), normalised.y());
  return {d.x, d.y};
}

Eigen::Matrix2d CameraModel::distort_jacobian(const Eigen::Vector2d& normalised) const {
  const auto d = distorted(distortion, normalised.x(), normalised.y());
  Eigen::Matrix2d jacobian;
  jacobian << d.xx, d.xy, d.xy, d.yy;
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

namespace {

// From a guess: of the step before the last one, which the next one leaves the square of.
constexpr int kMaxSteps = 6;
constexpr double kTolerance = 3e-5;

}  // namespace

std::optional<Eigen::Vector2d> CameraModel::undistort(const Eigen::Vector2d& distorted,
                                                      const Eigen::Vector2d& guess) const {
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

bool CameraModel::undistort(const Points<Sixteen>& wanted, Points<Sixteen>& guess) const {
  constexpr int kCount = 16;
  Sixteen &x = guess.x, &y = guess.y;
  for (int step = 0; step < kMaxSteps; ++step) {
    const auto d = distorted(distortion, x, y);
    const Sixteen determinant = d.xx * d.yy - d.xy * d.xy;
    const Sixteen u = (d.x - wanted.x) / determinant, v = (d.y - wanted.y) / determinant;
    const Sixteen dx = d.yy * u - d.xy * v, dy = d.xx * v - d.xy * u;
    x -= dx;
    y -= dy;
    const Sixteen moved = dx * dx + dy * dy, r2 = x * x + y * y;
    double least = determinant[0], most = moved[0], farthest = r2[0];
    for (int i = 1; i < kCount; ++i) {
      least = std::min(least, determinant[i]);
      most = std::max(most, moved[i]);
      farthest = std::max(farthest, r2[i]);
    }
    if (!(least > 1e-9)) return false;
    if (most < kTolerance * kTolerance) return before_fold(distortion, farthest);
  }
  return false;
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
