#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "daemon/latency_histogram.hpp"
#include "transport/frame_assembler.hpp"

namespace roundel {

// What a receiver can say at the end about how frames arrived.
class ReceptionSummary {
 public:
  // A frame, when its last part arrived on the wall clock, and now on a steady clock; microseconds.
  void add(const ReceivedFrame& frame, std::int64_t received_utime, std::int64_t now_us);

  std::string text(const ReceptionCounts& counts) const;
  nlohmann::ordered_json json(const ReceptionCounts& counts) const;

 private:
  double rate() const;  // frames a second

  LatencyHistogram latency_;  // from capture to arrival; of no meaning between machines whose
                              // clocks do not agree
  LatencyHistogram interval_;  // from one frame to the next
  std::int64_t first_us_ = 0, last_us_ = 0;
  std::int64_t frames_ = 0, markers_ = 0;
};

}  // namespace roundel
