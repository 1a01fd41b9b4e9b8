#include "tests/boot/robot.hpp"

#include <algorithm>

#include "transport/clock.hpp"

namespace roundel {

Robot::Robot(const std::string& channel)
    : subscriber_("udpm://239.255.76.67:7667?ttl=1", channel) {}

std::optional<std::int64_t> Robot::poses_after(std::int64_t instant_us) {
  constexpr std::int64_t kPatienceUs = 30'000'000;
  constexpr int kRobots = 4;
  const std::int64_t end_us = now().mono_us + kPatienceUs;
  while (now().mono_us < end_us) {
    const ReceivedFrame* const frame = subscriber_.next_frame(std::chrono::milliseconds(100));
    if (frame == nullptr || frame->header.capture_mono <= instant_us) continue;
    const auto robots =
        std::count_if(frame->markers.begin(), frame->markers.end(),
                      [](const marker_t& marker) { return marker.id > 0 && marker.has_pose != 0; });
    if (robots != kRobots) continue;
    header_ = frame->header;
    camera_ = frame->camera;
    in_arena_ = header_.arena_state == header_t::ARENA_VALID;
    return header_.publish_mono;
  }
  return std::nullopt;
}

std::optional<std::int64_t> Robot::poses_now() {
  return poses_after(now().mono_us);
}

}  // namespace roundel
