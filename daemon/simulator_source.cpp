#include "daemon/simulator_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "transport/clock.hpp"

namespace roundel {

SimulatorSource::SimulatorSource(const ArenaOptions& options) : arena_(options) {
  arena_.render(0, image_);  // the first picture takes longer; nobody waits for it yet
  start_ns_ = monotonic_ns();
  timer_.arm(start_ns_);
}

std::int64_t SimulatorSource::instant_ns(std::int64_t frame) const {
  const double period_ns = 1e9 / arena_.options().frame_rate;
  return start_ns_ + std::llround(period_ns * static_cast<double>(frame));
}

std::optional<FrameLease> SimulatorSource::next() {
  if (!timer_.take()) return std::nullopt;
  if (last_frame_ < 0) start_ns_ = monotonic_ns();
  const double elapsed_s = static_cast<double>(monotonic_ns() - start_ns_) / 1e9;
  const auto newest = static_cast<std::int64_t>(elapsed_s * arena_.options().frame_rate);
  const std::int64_t number = std::max(newest, last_frame_ + 1);
  left_out_ += number - last_frame_ - 1;
  last_frame_ = number;
  timer_.arm(instant_ns(number + 1));

  arena_.render(number, image_);
  state_ = CameraState::kStreaming;

  // The frame shows the arena at the instant at which it was due.
  constexpr std::int64_t kNsPerUs = 1000;
  const TimeStamp current = now();
  const std::int64_t captured_us = instant_ns(number) / kNsPerUs;
  const TimeStamp captured = {current.wall_us - (current.mono_us - captured_us), captured_us};
  return FrameLease(
      *this, 0, {image_.view(), number, captured, StampSource::kMiddleOfExposure, current.mono_us});
}

std::string SimulatorSource::description() const {
  const ArenaOptions& options = arena_.options();
  return fmt::format("simulator {}x{} at {} frames/s, {} robots", width(), height(),
                     options.frame_rate, options.robots);
}

}  // namespace roundel
