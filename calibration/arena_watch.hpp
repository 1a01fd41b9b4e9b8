#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "calibration/arena_calibration.hpp"
#include "core/marker.hpp"

namespace roundel {

// Watches whether the fixed markers are still where the calibration saw them, over windows of some
// seconds. When most have gone elsewhere together, the camera has been moved; when one has, it was
// that one. Anything between (a hand, a robot) passes.
class ArenaWatch {
 public:
  explicit ArenaWatch(const ArenaCalibration& calibration);

  enum class State {
    kUnknown,  // no window is over yet, or no fixed marker is in view
    kInPlace,
    kCornerMoved,  // one of several
    kCameraMoved,
  };

  // The markers of a frame; the time is any that rises, microseconds. True if state or text may
  // have changed.
  bool add(std::span<const Marker> markers, std::int64_t time_us);

  State state() const { return state_; }
  // What was found, in a sentence for the user.
  const std::string& text() const { return text_; }

 private:
  struct Watched {
    int id = -1;
    std::string name;
    Eigen::Vector3d place;
    Eigen::Vector2d pixel;
    std::vector<Eigen::Vector2d> offsets;  // on the floor, metres, of this window
  };
  const Marker* find(const Watched& watched, std::span<const Marker> markers) const;
  void judge();

  Pose arena_in_camera_;
  double limit_m_;
  double reach_px_;
  std::vector<Watched> watched_;
  std::int64_t window_start_us_ = -1;
  int frames_ = 0;
  int windows_moved_ = 0;  // in a row
  State state_ = State::kUnknown;
  std::string text_;
};

}  // namespace roundel
