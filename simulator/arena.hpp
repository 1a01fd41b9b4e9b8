#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/camera_model.hpp"
#include "core/grey_image.hpp"
#include "simulator/scene.hpp"
#include "simulator/truth.hpp"

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

// The arena's picture and truth for any frame number. Deterministic: a frame depends on the options
// and its number alone. Going forward is cheap; going back starts the motion anew.
class Arena {
 public:
  // Throws std::invalid_argument, with a sentence for the user, for options that cannot be met.
  explicit Arena(const ArenaOptions& options);
  ~Arena();
  Arena(Arena&&) noexcept;
  Arena& operator=(Arena&&) noexcept;

  const ArenaOptions& options() const;
  const CameraModel& camera() const;
  // The arena frame in the camera frame.
  const Pose& arena_in_camera() const;

  // frame >= 0. No allocation once some frames have been rendered.
  void render(std::int64_t frame, GreyImage& out);

  // What render() shows; the reference holds until the next call of either with another frame.
  const FrameTruth& truth(std::int64_t frame);

  // Closest that two markers' plates come to each other on the floor in the frame, metres.
  double clearance_m(std::int64_t frame);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace roundel
