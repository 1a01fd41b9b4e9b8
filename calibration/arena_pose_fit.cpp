#include "calibration/arena_pose_fit.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Dense>
#include <cmath>

namespace roundel {
namespace {

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

// A first pose from the homography of the points' x and y. Heights differ by little beside the
// camera's distance; least squares mends what that costs.
std::optional<Pose> pose_by_homography(std::span<const PlacedRay> rays) {
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (const PlacedRay& ray : rays) middle += ray.place.head<2>();
  middle /= static_cast<double>(rays.size());
  double size = 0;
  for (const PlacedRay& ray : rays) size = std::max(size, (ray.place.head<2>() - middle).norm());
  if (!(size > 0)) return std::nullopt;

  Eigen::MatrixXd equations(2 * static_cast<Eigen::Index>(rays.size()), 9);
  Eigen::Index row = 0;
  for (const PlacedRay& ray : rays) {
    const Eigen::RowVector3d p = ((ray.place.head<2>() - middle) / size).homogeneous().transpose();
    equations.row(row++) << p, Eigen::RowVector3d::Zero(), -ray.seen.x() * p;
    equations.row(row++) << Eigen::RowVector3d::Zero(), p, -ray.seen.y() * p;
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(equations, Eigen::ComputeFullV);
  constexpr double kRank = 1e-4;  // of the eight equations that count
  if (svd.singularValues()(7) < kRank * svd.singularValues()(0)) return std::nullopt;
  const Eigen::VectorXd h = svd.matrixV().col(8);
  Eigen::Matrix3d homography;
  homography << h(0), h(1), h(2), h(3), h(4), h(5), h(6), h(7), h(8);
  homography.leftCols<2>() /= size;
  if (homography(2, 2) < 0) homography = -homography;  // the middle is in front of the camera

  const double scale = 1 / std::sqrt(homography.col(0).norm() * homography.col(1).norm());
  if (!std::isfinite(scale)) return std::nullopt;
  Eigen::Matrix3d axes;
  axes.col(0) = homography.col(0) * scale;
  axes.col(1) = homography.col(1) * scale;
  axes.col(2) = axes.col(0).cross(axes.col(1));
  const Eigen::JacobiSVD<Eigen::Matrix3d> nearest(axes, Eigen::ComputeFullU | Eigen::ComputeFullV);
  axes = nearest.matrixU() * nearest.matrixV().transpose();
  if (axes.determinant() < 0) return std::nullopt;
  const Eigen::Vector3d at_middle = homography.col(2) * scale;
  if (!(axes.col(2).dot(at_middle) < 0)) return std::nullopt;  // seen from below
  Pose pose;
  pose.orientation = with_positive_w(Eigen::Quaterniond(axes).normalized());
  pose.position = at_middle - axes.leftCols<2>() * middle;
  return pose;
}

struct NormalEquations {
  PoseCovariance matrix = PoseCovariance::Zero();
  Eigen::Matrix<double, 6, 1> gradient = Eigen::Matrix<double, 6, 1>::Zero();
  double cost = 0;
};

// Nothing if a point would lie behind the camera.
std::optional<NormalEquations> linearise(std::span<const PlacedRay> rays, const Pose& pose) {
  NormalEquations sum;
  for (const PlacedRay& ray : rays) {
    const Eigen::Vector3d p = pose.to_camera(ray.place);
    if (!(p.z() > 0)) return std::nullopt;
    const Eigen::Vector2d residual = p.head<2>() / p.z() - ray.seen;
    const Eigen::Matrix<double, 2, 6> by_pose = point_sensitivity(pose, ray.place).by_pose;
    sum.matrix += by_pose.transpose() * ray.information * by_pose;
    sum.gradient += by_pose.transpose() * ray.information * residual;
    sum.cost += residual.dot(ray.information * residual);
  }
  return sum;
}

Pose moved(const Pose& pose, const Eigen::Matrix<double, 6, 1>& step) {
  const Eigen::Vector3d turn = step.tail<3>();
  Pose result;
  result.position = pose.position + step.head<3>();
  const double angle = turn.norm();
  const Eigen::Quaterniond rotation =
      angle > 0 ? Eigen::Quaterniond(Eigen::AngleAxisd(angle, turn / angle))
                : Eigen::Quaterniond::Identity();
  result.orientation = with_positive_w((rotation * pose.orientation).normalized());
  return result;
}

}  // namespace

PointSensitivity point_sensitivity(const Pose& arena_in_camera, const Eigen::Vector3d& place) {
  const Eigen::Vector3d arm = arena_in_camera.orientation * place;
  const Eigen::Vector3d p = arm + arena_in_camera.position;
  PointSensitivity result;
  result.by_camera << 1, 0, -p.x() / p.z(), 0, 1, -p.y() / p.z();
  result.by_camera /= p.z();
  result.by_pose << result.by_camera, -result.by_camera * cross_matrix(arm);
  result.by_floor = result.by_camera * arena_in_camera.orientation.toRotationMatrix().leftCols<2>();
  return result;
}

Eigen::Matrix2d floor_covariance(const Pose& arena_in_camera, const PoseCovariance& covariance,
                                 const Eigen::Vector3d& place) {
  const PointSensitivity image = point_sensitivity(arena_in_camera, place);
  const Eigen::Matrix<double, 2, 6> by_pose = image.by_floor.inverse() * image.by_pose;
  return by_pose * covariance * by_pose.transpose();
}

std::optional<Eigen::Vector3d> on_plane(const Pose& arena_in_camera, const Eigen::Vector2d& seen,
                                        double height_m) {
  constexpr double kFlattest = 0.02;  // sine of the angle between ray and floor
  const Eigen::Quaterniond to_arena = arena_in_camera.orientation.conjugate();
  const Eigen::Vector3d camera = to_arena * -arena_in_camera.position;
  const Eigen::Vector3d ray = to_arena * seen.homogeneous().normalized();
  const double distance = (height_m - camera.z()) / ray.z();
  if (std::abs(ray.z()) < kFlattest || !(distance > 0)) return std::nullopt;
  Eigen::Vector3d point = camera + distance * ray;
  point.z() = height_m;
  return point;
}

std::optional<ArenaPoseFit> fit_arena_pose(std::span<const PlacedRay> rays) {
  constexpr std::size_t kLeastRays = 4;
  constexpr int kMaxSteps = 30;
  constexpr double kConverged = 1e-12;  // metres and radians
  if (rays.size() < kLeastRays) return std::nullopt;
  const std::optional<Pose> start = pose_by_homography(rays);
  if (!start) return std::nullopt;

  Pose pose = *start;
  std::optional<NormalEquations> equations = linearise(rays, pose);
  double damping = 1e-6;
  for (int i = 0; equations && i < kMaxSteps; ++i) {
    PoseCovariance damped = equations->matrix;
    damped.diagonal() *= 1 + damping;
    const Eigen::Matrix<double, 6, 1> step = damped.ldlt().solve(-equations->gradient);
    if (!step.allFinite()) return std::nullopt;
    const Pose next = moved(pose, step);
    const std::optional<NormalEquations> there = linearise(rays, next);
    if (!there || there->cost > equations->cost) {
      damping *= 10;
      if (step.norm() < kConverged) break;
      continue;
    }
    pose = next;
    equations = there;
    damping *= 0.1;
    if (step.norm() < kConverged) break;
  }
  if (!equations) return std::nullopt;
  ArenaPoseFit fit;
  fit.arena_in_camera = pose;
  fit.covariance = equations->matrix.ldlt().solve(PoseCovariance::Identity());
  fit.chi_square = equations->cost;
  if (!fit.covariance.allFinite() || pose.normal().dot(pose.position) >= 0) return std::nullopt;
  return fit;
}

}  // namespace roundel
