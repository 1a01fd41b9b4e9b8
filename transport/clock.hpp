#pragma once

#include <cstdint>

namespace roundel {

// One instant on two clocks, microseconds: see transport/lcm/header_t.lcm.
struct TimeStamp {
  std::int64_t wall_us = 0;  // since the Unix epoch
  std::int64_t mono_us = 0;  // CLOCK_MONOTONIC
};

TimeStamp now();

// CLOCK_MONOTONIC, nanoseconds, for timing and for timers.
std::int64_t monotonic_ns();

}  // namespace roundel
