#pragma once

#include <Eigen/Core>
#include <array>

#include "core/camera_model.hpp"

namespace roundel {

// What a camera calibration estimates besides the board's poses, in this order.
enum IntrinsicParameter {
  kFx,  // pixels
  kFy,
  kCx,
  kCy,
  kK1,
  kK2,
  kP1,
  kP2,
  kK3,
  kIntrinsicParameters
};

inline constexpr std::array<const char*, kIntrinsicParameters> kIntrinsicNames = {
    "fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3"};

using IntrinsicVector = Eigen::Matrix<double, kIntrinsicParameters, 1>;
using IntrinsicMatrix = Eigen::Matrix<double, kIntrinsicParameters, kIntrinsicParameters>;
using IntrinsicMask = std::array<bool, kIntrinsicParameters>;

inline IntrinsicVector to_vector(const CameraModel& camera) {
  const auto& d = camera.distortion;
  IntrinsicVector v;
  v << camera.fx, camera.fy, camera.cx, camera.cy, d.k1, d.k2, d.p1, d.p2, d.k3;
  return v;
}

// The camera of these parameters; `like` gives the resolution.
inline CameraModel to_camera(const IntrinsicVector& v, const CameraModel& like) {
  CameraModel camera = like;
  camera.fx = v[kFx];
  camera.fy = v[kFy];
  camera.cx = v[kCx];
  camera.cy = v[kCy];
  camera.distortion = {v[kK1], v[kK2], v[kP1], v[kP2], v[kK3]};
  return camera;
}

}  // namespace roundel
