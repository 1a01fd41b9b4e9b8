#include "tools/reception_summary.hpp"

#include <fmt/format.h>

namespace roundel {
namespace {

using Json = nlohmann::ordered_json;

Json percentiles_json(const LatencyHistogram& histogram) {
  return {{"p50", histogram.percentile_us(0.50)},
          {"p90", histogram.percentile_us(0.90)},
          {"p99", histogram.percentile_us(0.99)},
          {"max", histogram.max_us()}};
}

std::string percentiles_text(const LatencyHistogram& histogram) {
  return fmt::format("{:.2f} ms (99 %: {:.2f} ms, worst {:.2f} ms)",
                     histogram.percentile_us(0.50) / 1000, histogram.percentile_us(0.99) / 1000,
                     static_cast<double>(histogram.max_us()) / 1000);
}

double share(std::int64_t part, std::int64_t rest) {
  return part + rest == 0 ? 0 : static_cast<double>(part) / static_cast<double>(part + rest);
}

}  // namespace

void ReceptionSummary::add(const ReceivedFrame& frame, std::int64_t received_utime,
                           std::int64_t now_us) {
  if (frames_ == 0) first_us_ = now_us;
  if (frames_ > 0) interval_.add(now_us - last_us_);
  last_us_ = now_us;
  ++frames_;
  markers_ += static_cast<std::int64_t>(frame.markers.size());
  latency_.add(received_utime - frame.header.capture_utime);
}

double ReceptionSummary::rate() const {
  return last_us_ == first_us_
             ? 0
             : static_cast<double>(frames_ - 1) * 1e6 / static_cast<double>(last_us_ - first_us_);
}

std::string ReceptionSummary::text(const ReceptionCounts& counts) const {
  if (frames_ == 0) return "no frame arrived\n";
  return fmt::format(
      "{} frames, {:.1f} a second, {:.1f} markers in each; {} lost ({:.2f} %), {} messages that "
      "were no frame\nfrom capture to arrival {}; from frame to frame {}\n",
      frames_, rate(), static_cast<double>(markers_) / static_cast<double>(frames_), counts.lost,
      100 * share(counts.lost, counts.frames), counts.garbage, percentiles_text(latency_),
      percentiles_text(interval_));
}

Json ReceptionSummary::json(const ReceptionCounts& counts) const {
  return {{"frames", frames_},
          {"markers", markers_},
          {"rate", rate()},
          {"lost", counts.lost},
          {"garbage", counts.garbage},
          {"latency_us", percentiles_json(latency_)},
          {"interval_us", percentiles_json(interval_)}};
}

}  // namespace roundel
