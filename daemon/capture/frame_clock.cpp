#include "daemon/capture/frame_clock.hpp"

#include <linux/videodev2.h>

namespace roundel {
namespace {

StampSource source_of(std::uint32_t flags) {
  return (flags & V4L2_BUF_FLAG_TSTAMP_SRC_MASK) == V4L2_BUF_FLAG_TSTAMP_SRC_SOE
             ? StampSource::kStartOfFrame
             : StampSource::kEndOfFrame;
}

}  // namespace

std::optional<CaptureTime> FrameClock::judge(const DriverStamp& stamp, TimeStamp arrived) {
  const bool monotonic =
      (stamp.flags & V4L2_BUF_FLAG_TIMESTAMP_MASK) == V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
  // Compared before subtracting: an absurd stamp may be anywhere.
  const bool future = stamp.mono_us > arrived.mono_us + kFutureUs;
  const bool old = stamp.mono_us < arrived.mono_us - kOldestUs;
  if (monotonic && !future && !old && stamp.mono_us > last_us_) {
    trusted_ = true;
    stale_ = 0;
    last_us_ = stamp.mono_us;
    const std::int64_t age_us = arrived.mono_us - stamp.mono_us;
    return CaptureTime{{arrived.wall_us - age_us, stamp.mono_us}, source_of(stamp.flags)};
  }
  // Older than the rest, but newer than the last one: it waited while nobody looked.
  if (monotonic && trusted_ && old && stamp.mono_us > last_us_ && stale_ < kMaxStale) {
    ++stale_;
    return std::nullopt;
  }
  trusted_ = false;
  ++refused_;
  return CaptureTime{arrived, StampSource::kArrival};
}

}  // namespace roundel
