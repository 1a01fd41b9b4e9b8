#pragma once

#include <cstdint>
#include <string>

#include "core/grey_image.hpp"
#include "daemon/frame_source.hpp"
#include "daemon/monotonic_timer.hpp"
#include "simulator/arena.hpp"

namespace roundel {

// Frames of a rendered arena in real time. Frame n is due n periods after the first was taken; if
// rendering and tracking take longer than a period, frames are left out, as with a camera.
class SimulatorSource final : public FrameSource {
 public:
  // Throws std::invalid_argument for options that can't be met.
  explicit SimulatorSource(const ArenaOptions& options);

  int descriptor() const override { return timer_.descriptor(); }
  std::optional<FrameLease> next() override;
  std::int64_t due_ns() const override { return instant_ns(last_frame_ + 1); }
  CameraState state() const override { return state_; }
  DropCounts drops() const override { return {.newer = left_out_}; }
  int width() const override { return arena_.camera().width; }
  int height() const override { return arena_.camera().height; }
  bool simulated() const override { return true; }
  std::string description() const override;
  std::string identity() const override { return "simulator"; }
  std::optional<CameraModel> camera() const override { return arena_.camera(); }

 private:
  std::int64_t instant_ns(std::int64_t frame) const;

  Arena arena_;
  GreyImage image_;
  MonotonicTimer timer_;
  CameraState state_ = CameraState::kStarting;
  std::int64_t start_ns_ = 0;  // of frame 0
  std::int64_t last_frame_ = -1;
  std::int64_t left_out_ = 0;
};

}  // namespace roundel
