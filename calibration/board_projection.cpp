#include "calibration/board_projection.hpp"

namespace roundel {
namespace {

constexpr double kMinDepth = 1e-6;  // metres

}  // namespace

std::optional<BoardProjection> project_board_point(const CameraModel& camera,
                                                   const Pose& board_in_camera,
                                                   const Eigen::Vector3d& place) {
  const Eigen::Vector3d arm = board_in_camera.orientation * place;
  const Eigen::Vector3d point = arm + board_in_camera.position;
  if (!(point.z() > kMinDepth)) return std::nullopt;
  const Eigen::Vector2d n = point.head<2>() / point.z();
  const Eigen::Vector2d d = camera.distort(n);
  const double x = n.x(), y = n.y(), r2 = n.squaredNorm();
  const Eigen::Vector2d focal(camera.fx, camera.fy);

  BoardProjection result;
  result.pixel = camera.to_pixel(d);
  auto& by = result.by_intrinsics;
  by.setZero();
  by(0, kFx) = d.x();
  by(1, kFy) = d.y();
  by(0, kCx) = by(1, kCy) = 1;
  by.col(kK1) = focal.cwiseProduct(n) * r2;
  by.col(kK2) = by.col(kK1) * r2;
  by.col(kK3) = by.col(kK2) * r2;
  by.col(kP1) = focal.cwiseProduct(Eigen::Vector2d(2 * x * y, r2 + 2 * y * y));
  by.col(kP2) = focal.cwiseProduct(Eigen::Vector2d(r2 + 2 * x * x, 2 * x * y));

  Eigen::Matrix<double, 2, 3> by_point;
  by_point << 1, 0, -x, 0, 1, -y;
  by_point = (focal.asDiagonal() * camera.distort_jacobian(n) * by_point / point.z()).eval();
  result.by_place = by_point * board_in_camera.orientation.toRotationMatrix();
  result.by_pose.leftCols<3>() = by_point;
  for (int i = 0; i < 2; ++i) {  // a rotation w moves the point by w x arm
    result.by_pose.row(i).tail<3>() = arm.cross(by_point.row(i).transpose()).transpose();
  }
  return result;
}

std::optional<Eigen::Vector2d> board_pixel(const CameraModel& camera, const Pose& board_in_camera,
                                           const Eigen::Vector3d& place) {
  const Eigen::Vector3d point = board_in_camera.to_camera(place);
  if (!(point.z() > kMinDepth)) return std::nullopt;
  return camera.to_pixel(camera.distort(point.head<2>() / point.z()));
}

Pose moved(const Pose& pose, const PoseStep& step) {
  Pose result = pose;
  result.position += step.head<3>();
  const double angle = step.tail<3>().norm();
  if (angle > 0) {
    const Eigen::AngleAxisd turn(angle, step.tail<3>() / angle);
    result.orientation =
        with_positive_w((Eigen::Quaterniond(turn) * pose.orientation).normalized());
  }
  return result;
}

}  // namespace roundel
