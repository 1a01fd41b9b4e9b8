#pragma once

#include <Eigen/Core>
#include <optional>

namespace roundel {

// Plumb-bob lens coefficients in OpenCV's and ROS's order and meaning.
struct Distortion {
  double k1 = 0, k2 = 0, p1 = 0, p2 = 0, k3 = 0;
};

// A pinhole camera with plumb-bob distortion. Pixel (0, 0) is the centre of the top-left pixel.
// "Normalised" coordinates are (X/Z, Y/Z) of the camera frame; "distorted" ones are after the lens.
struct CameraModel {
  int width = 0, height = 0;  // pixels; the resolution that the intrinsics belong to
  double fx = 1, fy = 1;      // focal lengths, pixels
  double cx = 0, cy = 0;      // principal point, pixels
  Distortion distortion;

  // Lens applied to a normalised point.
  Eigen::Vector2d distort(const Eigen::Vector2d& normalised) const;

  // Derivative of distort() at a normalised point, d(distorted)/d(normalised).
  Eigen::Matrix2d distort_jacobian(const Eigen::Vector2d& normalised) const;

  // Inverse of distort() to 1e-9 or better by Newton's method. Nothing where the lens model has no
  // inverse (beyond the radius at which it folds back).
  std::optional<Eigen::Vector2d> undistort(const Eigen::Vector2d& distorted) const;

  // The same to 1e-7 or better, from a guess near the result.
  std::optional<Eigen::Vector2d> undistort(const Eigen::Vector2d& distorted,
                                           const Eigen::Vector2d& guess) const;

  // The same of several points at once, x and y. False where one has no inverse.
  template <typename Numbers>
  struct Points {
    Numbers x, y;
  };
  using Sixteen __attribute__((vector_size(16 * sizeof(double)))) = double;
  bool undistort(const Points<Sixteen>& distorted, Points<Sixteen>& guess) const;

  // A pixel's normalised point, with the lens removed.
  std::optional<Eigen::Vector2d> normalise(const Eigen::Vector2d& pixel) const;

  // Pixel of a point in the camera frame (metres). Nothing for points not in front of the camera or
  // beyond the radius at which the lens model folds back.
  std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& in_camera) const;

  Eigen::Vector2d to_pixel(const Eigen::Vector2d& distorted) const {
    return {fx * distorted.x() + cx, fy * distorted.y() + cy};
  }
  Eigen::Vector2d from_pixel(const Eigen::Vector2d& pixel) const {
    return {(pixel.x() - cx) / fx, (pixel.y() - cy) / fy};
  }
};

}  // namespace roundel
