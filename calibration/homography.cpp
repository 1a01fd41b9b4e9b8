#include "calibration/homography.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace roundel {
namespace {

// Similarity that brings points to mean zero and mean distance sqrt(2), without which the direct
// linear transform loses its digits. Nothing for points that are all in one place.
template <typename Get>
std::optional<Eigen::Matrix3d> normalisation(std::span<const PlanePoint> points, Get&& get) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const PlanePoint& point : points) mean += get(point);
  mean /= static_cast<double>(points.size());
  double distance = 0;
  for (const PlanePoint& point : points) distance += (get(point) - mean).norm();
  distance /= static_cast<double>(points.size());
  if (!(distance > 0) || !std::isfinite(distance)) return std::nullopt;
  const double scale = std::numbers::sqrt2 / distance;
  Eigen::Matrix3d similarity;
  similarity << scale, 0, -scale * mean.x(), 0, scale, -scale * mean.y(), 0, 0, 1;
  return similarity;
}

// A small generator with a fixed start: the same pictures always give the same calibration.
class Draw {
 public:
  std::size_t below(std::size_t count) {
    state_ = state_ * 6364136223846793005U + 1442695040888963407U;
    return static_cast<std::size_t>(((state_ >> 33) * count) >> 31);
  }

 private:
  std::uint64_t state_ = 1;
};

}  // namespace

std::optional<Eigen::Matrix3d> fit_homography(std::span<const PlanePoint> points) {
  if (points.size() < 4) return std::nullopt;
  const auto from = normalisation(points, [](const PlanePoint& p) { return p.on_plane; });
  const auto to = normalisation(points, [](const PlanePoint& p) { return p.seen; });
  if (!from || !to) return std::nullopt;
  Eigen::Matrix<double, 9, 9> normal_matrix = Eigen::Matrix<double, 9, 9>::Zero();
  for (const PlanePoint& point : points) {
    const Eigen::Vector3d a = *from * point.on_plane.homogeneous();
    const Eigen::Vector2d b = (*to * point.seen.homogeneous()).head<2>();
    for (int axis = 0; axis < 2; ++axis) {
      Eigen::Matrix<double, 9, 1> row = Eigen::Matrix<double, 9, 1>::Zero();
      row.segment<3>(3 * axis) = a;
      row.tail<3>() = -b[axis] * a;
      normal_matrix += row * row.transpose();
    }
  }
  const Eigen::JacobiSVD<Eigen::Matrix<double, 9, 9>> svd(normal_matrix, Eigen::ComputeFullV);
  // Two directions without information: the points lie on a line (or worse).
  if (!(svd.singularValues()[7] > 1e-10 * svd.singularValues()[0])) return std::nullopt;
  const Eigen::Matrix<double, 9, 1> h = svd.matrixV().col(8);
  Eigen::Matrix3d normalised;
  normalised << h.segment<3>(0).transpose(), h.segment<3>(3).transpose(),
      h.segment<3>(6).transpose();
  Eigen::Matrix3d homography = to->inverse() * normalised * *from;
  homography /= homography.norm();
  if (!homography.allFinite()) return std::nullopt;
  // The origin lies in the middle of what is seen: its third coordinate has the sign of depth.
  if (homography(2, 2) < 0) homography = -homography;
  return homography;
}

Eigen::Vector2d apply(const Eigen::Matrix3d& homography, const Eigen::Vector2d& on_plane) {
  return (homography * on_plane.homogeneous()).hnormalized();
}

std::vector<bool> consensus(std::span<const PlanePoint> points, double tolerance) {
  constexpr int kDraws = 200;
  std::vector<bool> best(points.size(), false);
  if (points.size() < 4) return best;
  std::size_t best_count = 0;
  Draw draw;
  for (int i = 0; i < kDraws && best_count < points.size(); ++i) {
    std::array<PlanePoint, 4> sample;
    for (PlanePoint& point : sample) point = points[draw.below(points.size())];
    const auto homography = fit_homography(sample);  // nothing if one was drawn twice
    if (!homography) continue;
    std::vector<bool> near(points.size(), false);
    std::size_t count = 0;
    for (std::size_t k = 0; k < points.size(); ++k) {
      near[k] = (apply(*homography, points[k].on_plane) - points[k].seen).norm() < tolerance;
      if (near[k]) ++count;
    }
    if (count > best_count) {
      best = near;
      best_count = count;
    }
  }
  return best;
}

std::optional<Pose> pose_from_homography(const Eigen::Matrix3d& homography) {
  const double scale = 0.5 * (homography.col(0).norm() + homography.col(1).norm());
  if (!(scale > 0)) return std::nullopt;
  const Eigen::Matrix3d h = homography * ((homography(2, 2) < 0 ? -1 : 1) / scale);
  Eigen::Matrix3d axes;
  axes << h.col(0), h.col(1), h.col(0).cross(h.col(1));
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(axes, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Matrix3d rotation = svd.matrixU() * svd.matrixV().transpose();
  if (!(h(2, 2) > 0) || !rotation.allFinite() || rotation.determinant() < 0) return std::nullopt;
  Pose pose;
  pose.position = h.col(2);
  pose.orientation = with_positive_w(Eigen::Quaterniond(rotation).normalized());
  return pose;
}

}  // namespace roundel
