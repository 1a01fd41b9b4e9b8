#pragma once

#include <Eigen/Core>

#include "core/camera_model.hpp"
#include "core/conic.hpp"
#include "core/marker.hpp"

namespace roundel {

// A circle's pose made complete by the turn about its normal: `yaw` is measured counter-clockwise
// as seen on the printed face, from the projection of the camera's x axis on the marker's plane to
// the marker's x axis. With yaw 0 it is the pose of a plain marker (DESIGN.md section 4).
Pose pose_from_circle(const CirclePose& circle, double yaw);

// From a marker's plane to pixels. Plane coordinates (x, y) are in units of the outer radius, seen
// on the printed face: x right, y up, the outer edge is the unit circle.
class PlaneProjection {
 public:
  // By a pose, a radius in metres and the lens; `camera` must outlive the object.
  PlaneProjection(const Pose& marker_in_camera, double radius_m, const CameraModel& camera);

  // Without a camera: the affine map that takes the unit circle to the ellipse and turns nothing.
  explicit PlaneProjection(const Ellipse& ellipse);

  Eigen::Vector2d pixel(double x, double y) const {
    const Eigen::Vector3d p = to_image_.col(0) * x + to_image_.col(1) * y + to_image_.col(2);
    const Eigen::Vector2d q = p.head<2>() / p.z();
    return camera_ ? camera_->to_pixel(camera_->distort(q)) : q;
  }

 private:
  Eigen::Matrix3d
      to_image_;  // homogeneous: to normalised coordinates, or to pixels without a camera
  const CameraModel* camera_ = nullptr;
};

}  // namespace roundel
