#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/camera_model.hpp"
#include "simulator/scene.hpp"

namespace roundel {

// A swarm arena under one camera. The defaults are those of METHOD.md section 9: 3 m x 2 m seen
// from 3 m above in Full HD at 30 frames a second.
struct ArenaOptions {
  int image_width = 1920, image_height = 1080;  // pixels
  double frame_rate = 30;
  std::uint64_t seed = 1;  // of motion, clutter and noise

  int robots = 12;
  std::vector<int> robot_ids;  // one a robot, from 1; empty: 1, 2, 3, ... Ids may be worn twice
  int bits = 8;                // WhyCode bits; 0: robots wear plain WhyCon markers
  int hamming = 1;
  double diameter_m = kDefaultDiameter;
  double plate_ratio = kMarginRatio;
  double inner_ratio = kPlainInnerRatio;  // of WhyCon markers

  bool corners = true;  // four markers flat on the floor at (0, 0), (L, 0), (L, W), (0, W)
  MarkerKind corner_kind = MarkerKind::WhyCon;  // WhyCode: the ids after the robots' last one

  double length_m = 3, width_m = 2;                 // of the floor, along arena x and y
  double camera_height_m = 3;                       // above the floor
  double camera_tilt = 0;                           // about the image's u axis, radians
  double camera_turn = 0;                           // about the optical axis, radians
  double min_height_m = 0.03, max_height_m = 0.10;  // of the robots' markers above the floor
  double max_speed = 0.3;                           // m/s
  double max_turn_rate = 1.5;                       // rad/s
  bool close_passes = false;  // robots seek each other and pass within millimetres
  bool clutter = true;        // things on the floor, some of them much like markers
  bool occluder = false;      // a bar that moves to and fro above the robots

  Imaging imaging = {.blur_px = 0.7, .exposure_s = 0.005, .noise_sigma = 3};
  std::optional<CameraModel> camera;  // instead of the default lens; its size replaces the image's
};

// The options, if they make sense by themselves; otherwise std::invalid_argument that says which
// does not. Whether robots fit on the floor and the arena into the picture is found out by trying.
const ArenaOptions& checked(const ArenaOptions& options);

// The ids that the markers wear: one a robot, then one a corner if corners have codes; none where
// markers have no code. Throws std::invalid_argument when the code has not that many, naming how
// many it has and how many bits would do.
std::vector<int> worn_ids(const ArenaOptions& options);

}  // namespace roundel
