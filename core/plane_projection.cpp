#include "core/plane_projection.hpp"

#include <cmath>

namespace roundel {

Pose pose_from_circle(const CirclePose& circle, double yaw) {
  const Eigen::Vector3d& z = circle.normal;
  Eigen::Vector3d x = Eigen::Vector3d::UnitX() - z * z.x();
  // Seen exactly edge-on from the side the camera's x axis has no projection; any direction will
  // do.
  x = x.squaredNorm() > 1e-12 ? x.normalized() : z.unitOrthogonal();
  const Eigen::Vector3d y = z.cross(x);
  Eigen::Matrix3d axes;
  axes.col(0) = std::cos(yaw) * x + std::sin(yaw) * y;
  axes.col(1) = z.cross(axes.col(0));
  axes.col(2) = z;
  return {circle.centre, with_positive_w(Eigen::Quaterniond(axes).normalized())};
}

PlaneProjection::PlaneProjection(const Pose& marker_in_camera, double radius_m,
                                 const CameraModel& camera)
    : camera_(&camera) {
  const Eigen::Matrix3d axes = marker_in_camera.orientation.toRotationMatrix();
  to_image_.col(0) = radius_m * axes.col(0);
  to_image_.col(1) = radius_m * axes.col(1);
  to_image_.col(2) = marker_in_camera.position;
}

PlaneProjection::PlaneProjection(const Ellipse& ellipse) {
  const double cosine = std::cos(ellipse.angle), sine = std::sin(ellipse.angle);
  // The symmetric root of the ellipse's matrix: it stretches along the axes and does not turn.
  const double uu = ellipse.a * cosine * cosine + ellipse.b * sine * sine;
  const double uv = (ellipse.a - ellipse.b) * cosine * sine;
  const double vv = ellipse.a * sine * sine + ellipse.b * cosine * cosine;
  to_image_ << uu, -uv, ellipse.u, uv, -vv, ellipse.v, 0, 0, 1;  // y up on the face, v down
}

}  // namespace roundel
