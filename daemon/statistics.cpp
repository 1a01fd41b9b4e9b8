#include "daemon/statistics.hpp"

#include <sys/timex.h>

namespace roundel {
namespace {

latency_t take(LatencyHistogram& histogram) {
  latency_t latency{};
  latency.p50 = static_cast<float>(histogram.percentile_us(0.50));
  latency.p90 = static_cast<float>(histogram.percentile_us(0.90));
  latency.p99 = static_cast<float>(histogram.percentile_us(0.99));
  latency.max = static_cast<float>(histogram.max_us());
  histogram.clear();
  return latency;
}

}  // namespace

void Statistics::add(const FrameTimes& times, std::size_t markers) {
  arrival_.add(times.arrived_us - times.captured_us);
  reading_.add(times.readable_us - times.arrived_us);
  tracking_.add(times.tracked_us - times.readable_us);
  following_.add(times.stages.following_ns / 1000);
  searching_.add(times.stages.searching_ns / 1000);
  identifying_.add(times.stages.identifying_ns / 1000);
  publishing_.add(times.published_us - times.tracked_us);
  handling_.add(times.published_us - times.arrived_us);
  total_.add(times.published_us - times.captured_us);
  markers_ = markers;
  ++frames_;
  ++frames_since_report_;
}

void Statistics::report(TimeStamp current, status_t& status) {
  const std::int64_t interval_us = current.mono_us - last_us_;
  status.uptime = current.mono_us - start_us_;
  status.frames = frames_;
  status.frame_rate = interval_us <= 0
                          ? 0.0F
                          : static_cast<float>(static_cast<double>(frames_since_report_) * 1e6 /
                                               static_cast<double>(interval_us));
  // Nothing is seen where nothing is looked at.
  status.markers = frames_since_report_ > 0 ? static_cast<std::int32_t>(markers_) : 0;
  status.arrival = take(arrival_);
  status.reading = take(reading_);
  status.tracking = take(tracking_);
  status.following = take(following_);
  status.searching = take(searching_);
  status.identifying = take(identifying_);
  status.publishing = take(publishing_);
  status.handling = take(handling_);
  status.total = take(total_);
  frames_since_report_ = 0;
  last_us_ = current.mono_us;
}

ClockState clock_state() {
  timex query{};  // modes = 0: only asks
  const int state = ::adjtimex(&query);
  if (state < 0) return ClockState::kUnknown;
  return (query.status & STA_UNSYNC) != 0 ? ClockState::kFreeRunning : ClockState::kSynchronised;
}

}  // namespace roundel
