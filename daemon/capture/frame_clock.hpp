#pragma once

#include <cstdint>
#include <optional>

#include "transport/clock.hpp"
#include "transport/frame_information.hpp"

namespace roundel {

// What a driver says about when a frame was taken.
struct DriverStamp {
  std::int64_t mono_us = 0;
  std::uint32_t flags = 0;  // V4L2_BUF_FLAG_TIMESTAMP_..., V4L2_BUF_FLAG_TSTAMP_SRC_...
};

struct CaptureTime {
  TimeStamp captured;
  StampSource source = StampSource::kUnknown;
};

// Judges a driver's time stamps and puts them on both clocks. A stamp of CLOCK_MONOTONIC that lies
// in the last 0.9 s, after the one before, is believed. What is older although stamps were right so
// far is a stale frame; any other stamp is absurd, and the frame gets the time of its arrival.
class FrameClock {
 public:
  static constexpr std::int64_t kOldestUs = 900'000;
  static constexpr std::int64_t kFutureUs = 1'000;  // a camera's own clock may run ahead a little
  static constexpr int kMaxStale =
      10;  // in a row: then the driver's clock is wrong, not the frames

  // Nothing: the frame is stale.
  std::optional<CaptureTime> judge(const DriverStamp& stamp, TimeStamp arrived);

  // Whether the last stamp was right: then an old frame shows by its stamp.
  bool trusted() const { return trusted_; }
  std::int64_t refused() const { return refused_; }  // absurd stamps so far

 private:
  bool trusted_ = false;
  int stale_ = 0;
  std::int64_t last_us_ = 0;
  std::int64_t refused_ = 0;
};

}  // namespace roundel
