#include "core/conic.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

namespace roundel {

std::optional<Conic> fit_conic(std::span<const Eigen::Vector2d> points) {
  if (points.size() < 5) return std::nullopt;
  // Shifted to the mean and scaled to unit size: the five unknowns are then alike in magnitude.
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& p : points) mean += p;
  mean /= static_cast<double>(points.size());
  double square = 0;
  for (const Eigen::Vector2d& p : points) square += (p - mean).squaredNorm();
  const double scale = std::sqrt(static_cast<double>(points.size()) / square);
  if (!std::isfinite(scale)) return std::nullopt;

  using Vector5 = Eigen::Matrix<double, 5, 1>;
  Eigen::Matrix<double, 5, 5> normal_matrix = Eigen::Matrix<double, 5, 5>::Zero();
  Vector5 right_side = Vector5::Zero();
  for (const Eigen::Vector2d& p : points) {
    const Eigen::Vector2d q = (p - mean) * scale;
    Vector5 row;
    row << q.x() * q.x(), q.x() * q.y(), q.y() * q.y(), q.x(), q.y();
    normal_matrix.noalias() += row * row.transpose();
    right_side += row;
  }
  const Eigen::LDLT<Eigen::Matrix<double, 5, 5>> solver(normal_matrix);
  if (solver.info() != Eigen::Success) return std::nullopt;
  const Vector5 c = solver.solve(right_side);
  if (!c.allFinite() || !(4 * c[0] * c[2] > c[1] * c[1])) return std::nullopt;  // no ellipse

  Conic local;
  local << c[0], c[1] / 2, c[3] / 2, c[1] / 2, c[2], c[4] / 2, c[3] / 2, c[4] / 2, -1;
  Eigen::Matrix3d to_local;
  to_local << scale, 0, -scale * mean.x(), 0, scale, -scale * mean.y(), 0, 0, 1;
  return to_local.transpose() * local * to_local;
}

std::optional<Conic> undistorted_conic(const Ellipse& ellipse, const CameraModel& camera) {
  constexpr int kPoints = 16;
  std::array<Eigen::Vector2d, kPoints> points;
  const double cosine = std::cos(ellipse.angle), sine = std::sin(ellipse.angle);
  for (int i = 0; i < kPoints; ++i) {
    const double t = 2 * std::numbers::pi * i / kPoints;
    const double along_a = ellipse.a * std::cos(t), along_b = ellipse.b * std::sin(t);
    const auto point = camera.normalise({ellipse.u + along_a * cosine - along_b * sine,
                                         ellipse.v + along_a * sine + along_b * cosine});
    if (!point) return std::nullopt;
    points[static_cast<std::size_t>(i)] = *point;
  }
  return fit_conic(points);
}

std::optional<std::array<CirclePose, 2>> circle_poses(const Conic& conic, double radius_m) {
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(conic);
  if (solver.info() != Eigen::Success) return std::nullopt;
  Eigen::Vector3d values = solver.eigenvalues();  // rising
  Eigen::Matrix3d vectors = solver.eigenvectors();
  // The sign of Q is free: two positive eigenvalues and a negative one are wanted.
  if (values[1] < 0) {
    values = -values.reverse().eval();
    vectors = vectors.rowwise().reverse().eval();
  }
  const double l0 = values[2], l1 = values[1], l2 = values[0];
  if (!(l1 > 0 && l2 < 0)) return std::nullopt;
  const Eigen::Vector3d q0 = vectors.col(2), q2 = vectors.col(0);

  const double a = std::sqrt(std::max(0.0, (l0 - l1) / (l0 - l2)));
  const double b = std::sqrt(std::max(0.0, (l1 - l2) / (l0 - l2)));
  const double range = radius_m / std::sqrt(-l0 * l2);
  std::array<CirclePose, 2> poses;
  for (std::size_t i = 0; i < 2; ++i) {
    const double s1 = i == 0 ? 1 : -1;
    Eigen::Vector3d centre = range * (s1 * l2 * a * q0 + l0 * b * q2);
    if (centre.z() < 0) centre = -centre;
    Eigen::Vector3d normal = s1 * a * q0 + b * q2;
    if (normal.dot(centre) > 0) normal = -normal;
    if (!(centre.z() > 0) || !centre.allFinite()) return std::nullopt;
    poses[i] = {centre, normal.normalized()};
  }
  return poses;
}

Pose mirrored_pose(const Pose& pose) {
  const Eigen::Vector3d sight = pose.position.normalized();
  const Eigen::Matrix3d axes = pose.orientation.toRotationMatrix();
  Eigen::Matrix3d other = axes - 2 * sight * (sight.transpose() * axes);
  other.col(2) = other.col(0).cross(other.col(1));
  return {pose.position, with_positive_w(Eigen::Quaterniond(other).normalized())};
}

}  // namespace roundel
