#pragma once

#include <optional>
#include <span>
#include <vector>

#include "calibration/arena_calibration.hpp"
#include "core/arena_pose.hpp"
#include "core/marker.hpp"

namespace roundel {

// 2D: a robot drives on the floor, its marker at a known height. 3D: a marker may be anywhere.
enum class ArenaMode { k2D, k3D };

// How a robot wears its marker. The robot's own frame: x ahead, y to its left, z up.
struct MarkerMount {
  double height_m = 0;    // of the marker's face above the floor; 2D only
  double offset_x_m = 0;  // of the marker's centre in the robot's frame
  double offset_y_m = 0;
  double rotation = 0;  // of the marker's x axis from the robot's, counter-clockwise, radians
};

struct IdMount {
  int id = 0;
  MarkerMount mount;
};

struct MarkerMounts {
  MarkerMount usual;           // of all markers but
  std::vector<IdMount> by_id;  // these
};

// From the camera to the arena (METHOD.md section 7). In 2D, a position is where the ray through
// the marker's projected centre meets the plane at the marker's height, and the heading is the
// code's direction on that plane; z is the height. Positions are of the robot: the mount's offset
// and rotation are taken off. No allocation in locate().
class ArenaMap {
 public:
  ArenaMap(const ArenaCalibration& calibration, ArenaMode mode, const MarkerMounts& mounts);

  ArenaMode mode() const { return mode_; }
  const Pose& arena_in_camera() const { return arena_in_camera_; }

  // Not valid for markers without a pose, and in 2D for those whose ray does not meet the floor.
  ArenaPose locate(const Marker& marker) const;

 private:
  struct FixedPixel {
    Eigen::Vector2d pixel;
    double height_m;
  };
  ArenaPose locate_on_floor(const Marker& marker, const MarkerMount& mount) const;
  ArenaPose locate_in_space(const Marker& marker) const;
  const Pose& pose_on_floor(const Marker& marker) const;
  std::optional<double> fixed_height(const Marker& marker) const;
  const MarkerMount& mount_of(int id) const;

  Pose arena_in_camera_;
  PoseCovariance covariance_;
  double focal_length_;  // pixels
  ArenaMode mode_;
  MarkerMount usual_;
  std::vector<MarkerMount> by_id_;  // index: id
  std::vector<FixedPixel> fixed_;
};

}  // namespace roundel
