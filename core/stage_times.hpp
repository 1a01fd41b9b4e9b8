#pragma once

#include <cstdint>

namespace roundel {

// What the stages of a tracked frame took, nanoseconds.
struct StageTimes {
  std::int64_t following_ns = 0;    // markers known from the frame before: found, fitted, read
  std::int64_t searching_ns = 0;    // for lost markers and newcomers: outlines
  std::int64_t identifying_ns = 0;  // what was found so: poses, codes, which tracks they belong to
};

// Takes the time between the ends of stages, with a clock that is given: core/ has none. Without
// one, nothing is measured.
class StageStopwatch {
 public:
  using Clock = std::int64_t (*)();  // nanoseconds, from any origin

  explicit StageStopwatch(Clock clock) : clock_(clock), last_ns_(clock ? clock() : 0) {}

  // Since the call before, or since it was made.
  std::int64_t lap_ns() {
    if (!clock_) return 0;
    const std::int64_t before = last_ns_;
    last_ns_ = clock_();
    return last_ns_ - before;
  }

 private:
  Clock clock_;
  std::int64_t last_ns_;
};

}  // namespace roundel
