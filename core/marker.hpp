#pragma once

#include <cstdint>

#include "core/pose.hpp"

namespace roundel {

// The image of a marker's outer edge: an ellipse in pixels. Invariant: a >= b > 0.
struct Ellipse {
  double u = 0, v = 0;  // centre, pixels
  double a = 0, b = 0;  // semi-axes, pixels
  double angle = 0;     // of the major axis, from +u toward +v, radians in (-pi/2, pi/2]
};

// One marker as it was seen in one frame: what `roundel --json` prints and LCM carries.
struct Marker {
  std::int32_t id = -1;       // 1-based; -1: the code can't be read, or there is none
  double id_probability = 0;  // that the id is right; 0 where id is -1
  std::int64_t track = 0;     // number of the track, from 1; 0 without tracking
  double u = 0, v = 0;        // image of the marker's centre, pixels; without a camera model the
                              // centre of the ellipse
  Ellipse ellipse;
  bool has_pose = false;  // false without a camera model; nothing below holds then
  Pose pose;              // marker in camera
  Eigen::Vector3d sigma_position =
      Eigen::Vector3d::Zero();  // one standard deviation, metres, camera axes
  Eigen::Vector3d sigma_rotation =
      Eigen::Vector3d::Zero();  // radians, rotations about the camera axes
  double ambiguity = 0;         // likelihood of the alternative over that of the pose, 0 ... 1
  bool has_alternative = false;
  Pose alternative;  // the other pose with the same outline
};

}  // namespace roundel
