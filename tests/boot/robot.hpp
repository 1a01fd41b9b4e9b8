#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "transport/subscriber.hpp"

namespace roundel {

// At the other end of the cable: receives poses by multicast.
class Robot {
 public:
  explicit Robot(const std::string& channel = "ROUNDEL");

  // The first frame with poses of all four robots that was captured after the instant
  // (CLOCK_MONOTONIC, microseconds; robot and camera share it here): when it was published. Nothing
  // if none comes within half a minute.
  std::optional<std::int64_t> poses_after(std::int64_t instant_us);
  std::optional<std::int64_t> poses_now();

  // Of the last frame that poses_after() found.
  const header_t& header() const { return header_; }
  const std::string& camera() const { return camera_; }
  bool in_arena() const { return in_arena_; }

 private:
  Subscriber subscriber_;
  header_t header_{};
  std::string camera_;
  bool in_arena_ = false;
};

}  // namespace roundel
