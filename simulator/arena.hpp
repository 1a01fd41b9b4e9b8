#pragma once

#include <cstdint>
#include <memory>

#include "core/camera_model.hpp"
#include "core/grey_image.hpp"
#include "core/pose.hpp"
#include "simulator/arena_options.hpp"
#include "simulator/truth.hpp"

namespace roundel {

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
