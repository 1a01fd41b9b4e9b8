#pragma once

#include "core/camera_model.hpp"
#include "core/pose.hpp"

namespace roundel::bench {

// Orientation of a marker that faces the camera, page up in the image, before it is turned.
inline Eigen::Quaterniond facing_camera() {
  return {0, 1, 0, 0};
}

// A facing marker turned about its own normal first (counter-clockwise on the page), then by
// `tilt` about the axis in the image plane at `axis_angle` (from +u toward +v). Radians.
Eigen::Quaterniond tilted(double tilt, double axis_angle, double turn);

// Angle between the printed face's normal and the line of sight, radians; 0 = seen frontally.
double incidence(const Pose& pose);

// Shortest diameter of a disc's image, pixels (to first order: by incidence and distance).
double short_side_px(const CameraModel& camera, const Pose& pose, double diameter_m);

// Whether a square plate of the given side, however it is turned, lies in the picture.
bool plate_in_picture(const CameraModel& camera, const Pose& pose, double plate_side_m);

}  // namespace roundel::bench
