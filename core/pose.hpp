#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace roundel {

// A rigid transform from the marker frame to the camera frame (DESIGN.md section 3).
// Camera frame: x right, y down, z forward. Marker frame: origin at the centre, z out of the
// printed face, x toward the start of the code's canonical word, y completing a right-handed frame.
// Invariant: orientation is a unit quaternion with w >= 0.
struct Pose {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();               // metres
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  // marker vectors to camera

  Eigen::Vector3d to_camera(const Eigen::Vector3d& in_marker) const {
    return orientation * in_marker + position;
  }
  // The printed face's unit normal, in the camera frame; it points to the camera: normal . position
  // < 0.
  Eigen::Vector3d normal() const { return orientation * Eigen::Vector3d::UnitZ(); }
};

// The same rotation with w >= 0.
inline Eigen::Quaterniond with_positive_w(const Eigen::Quaterniond& q) {
  return q.w() < 0 ? Eigen::Quaterniond(-q.w(), -q.x(), -q.y(), -q.z()) : q;
}

// Angle between two orientations, arccos |q1 . q2|, in [0, pi/2] ([P] eq. 5; half the angle of the
// rotation between them).
double orientation_error(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b);

}  // namespace roundel
