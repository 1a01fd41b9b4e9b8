#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "core/camera_model.hpp"
#include "core/covariance.hpp"
#include "core/pose.hpp"

namespace roundel {

// Which of the corners, as the camera sees them, is the arena's origin. From there x runs to the
// next corner counter-clockwise and y to the one before, so that z points up at the camera.
enum class ArenaOrigin { kBottomLeft, kBottomRight, kTopRight, kTopLeft };

// A marker that stands still at a known place of the arena.
struct ArenaAnchor {
  int id = 0;
  double x = 0, y = 0;  // arena frame, metres
};

// What a user asks for.
struct ArenaRequest {
  double width_m = 0;   // along x: from the first corner to the second
  double height_m = 0;  // along y: from the first corner to the fourth
  ArenaOrigin origin = ArenaOrigin::kBottomLeft;
  std::vector<int> ids;              // of the corners from the origin on, counter-clockwise as the
                                     // camera sees them; empty: the four outermost markers
  std::vector<ArenaAnchor> anchors;  // more fixed markers
  double corner_height_m = 0;        // of the corner markers' faces above the floor
  double corner_diameter_m = 0;      // of their black discs; 0: as all markers
  double certainty_m = 0.0003;       // one standard deviation on the floor to be reached
  double time_limit_s = 30;
  double tolerance_m = 0;  // of a residual; 0: 0.2 % of the diagonal, 3 mm at least
};

// The camera that a calibration belongs to.
struct ArenaCamera {
  std::string identity;    // as its source names it; empty: unknown
  std::string crop;        // part of the sensor that the frames show; empty: all
  CameraModel intrinsics;  // with the resolution
};

// A fixed marker of a calibrated arena.
struct ArenaReference {
  int id = -1;                                         // -1: no code
  Eigen::Vector3d place = Eigen::Vector3d::Zero();     // where it is said to be; arena, metres
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();     // where the camera saw it
  Eigen::Vector2d residual = Eigen::Vector2d::Zero();  // found minus said, arena x and y, metres
};

// An arena frame, how well it is known, and what it belongs to.
struct ArenaCalibration {
  ArenaRequest request;
  Pose arena_in_camera;
  PoseCovariance covariance = PoseCovariance::Zero();  // position, then rotation, camera axes
  std::vector<ArenaReference> references;              // corners from the origin on, then anchors
  std::array<double, 4> side_errors{};  // measured minus given, from the first corner on, metres
  double size_by_markers = 1;           // arena by the markers' own diameter, over the given one
  double certainty_m = 0;               // one standard deviation on the floor, worst corner
  int frames = 0;                       // that went into it
  ArenaCamera camera;
  std::string date;     // UTC, ISO 8601
  std::string version;  // of the program
};

// Whether a calibration may be used with a camera: empty if so, else why not, as a clause. Where it
// is not known which camera took the frames (identity empty), resolution and lens must do.
std::string mismatch(const ArenaCamera& calibrated, const ArenaCamera& now);

}  // namespace roundel
