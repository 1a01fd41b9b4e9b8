#pragma once

#include <cstdint>

namespace roundel {

// Frames that were not tracked, by reason.
struct DropCounts {
  std::int64_t lost = 0;     // before they reached roundeld: gaps in the driver's numbers
  std::int64_t newer = 0;    // a newer one was there
  std::int64_t damaged = 0;  // marked by the driver, too short, or can't be decoded
  std::int64_t stale = 0;    // waited too long

  std::int64_t total() const { return lost + newer + damaged + stale; }
  DropCounts& operator+=(const DropCounts& more) {
    lost += more.lost;
    newer += more.newer;
    damaged += more.damaged;
    stale += more.stale;
    return *this;
  }
  DropCounts operator-(const DropCounts& less) const {
    return {lost - less.lost, newer - less.newer, damaged - less.damaged, stale - less.stale};
  }
};

}  // namespace roundel
