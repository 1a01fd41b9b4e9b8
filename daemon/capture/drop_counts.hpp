#pragma once

#include <cstdint>

namespace roundel {

// Frames of a camera that were not tracked, by reason.
struct DropCounts {
  std::int64_t driver = 0;   // gaps in the driver's numbers: lost before they reached us
  std::int64_t newer = 0;    // a newer one was there
  std::int64_t damaged = 0;  // marked by the driver, too short, or a JPEG that can't be decoded
  std::int64_t stale = 0;    // waited too long

  std::int64_t total() const { return driver + newer + damaged + stale; }
  DropCounts& operator+=(const DropCounts& more) {
    driver += more.driver;
    newer += more.newer;
    damaged += more.damaged;
    stale += more.stale;
    return *this;
  }
};

}  // namespace roundel
