#pragma once

#include <Eigen/Core>

#include "core/camera_model.hpp"
#include "core/pose.hpp"

namespace roundel {

// Covariance of a pose: position (metres, camera axes) first, then a small rotation (radians, about
// the camera axes).
using PoseCovariance = Eigen::Matrix<double, 6, 6>;

// How well the parts of a marker's image are known.
struct EdgeNoise {
  double outline_px = 0;  // of one pixel of the outer outline, across it
  double yaw_rad = 0;     // of the turn about the normal, from the teeth; infinite without a code
};

// Inverse of the normal matrix of the outer outline's points and the yaw (METHOD.md section 6):
// what the outline's noise makes of the pose to first order. Where the tilt can't be told from the
// outline, the rotation's deviation ends at about half a radian.
PoseCovariance pose_covariance(const Pose& pose, double radius_m, const CameraModel& camera,
                               const EdgeNoise& noise);

// What a pose's covariance lacks when the parts of its marker disagree about it by more than noise
// lets them: shadows, glare, something over the outline, a motion that is no straight line. Both as
// worked out of the same residuals: taken part by part, and pixel by pixel. Nothing when the parts
// agree.
PoseCovariance disagreement_beyond_noise(const PoseCovariance& by_parts,
                                         const PoseCovariance& by_noise);

}  // namespace roundel
