#pragma once

#include <cstdint>

#include "core/stage_times.hpp"
#include "daemon/latency_histogram.hpp"
#include "transport/clock.hpp"
#include "transport/messages.hpp"

namespace roundel {

// When a frame passed each stage, CLOCK_MONOTONIC, microseconds.
struct FrameTimes {
  std::int64_t captured_us = 0;
  std::int64_t arrived_us = 0;
  std::int64_t readable_us = 0;  // decoded, where that is needed
  std::int64_t tracked_us = 0;
  std::int64_t published_us = 0;
  StageTimes stages;  // of the tracking
};

// What the status message tells about the frames since the one before. No allocation.
class Statistics {
 public:
  explicit Statistics(TimeStamp start) : start_us_(start.mono_us), last_us_(start.mono_us) {}

  void add(const FrameTimes& times, std::size_t markers);

  // Fills in uptime, frames, frame rate, markers and latencies, and begins a new interval.
  void report(TimeStamp current, status_t& status);

  std::int64_t frames() const { return frames_; }  // of this session
  // Frames are counted from 0 again.
  void begin_session() { frames_ = 0; }

 private:
  std::int64_t start_us_;
  std::int64_t last_us_;  // of the last report
  std::int64_t frames_ = 0;
  std::int64_t frames_since_report_ = 0;
  std::size_t markers_ = 0;
  LatencyHistogram arrival_, reading_, tracking_, following_, searching_, identifying_, publishing_,
      handling_, total_;
};

// What the kernel says about the wall clock.
ClockState clock_state();

}  // namespace roundel
