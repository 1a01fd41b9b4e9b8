#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "transport/frame_assembler.hpp"

namespace roundel {

// The poses as they arrive, for human eyes: one row a track, gone a second after it was last seen.
class PoseTable {
 public:
  // Times in microseconds: of the frame's arrival on the wall clock, and now on a steady clock.
  void add(const ReceivedFrame& frame, const ReceptionCounts& counts, std::int64_t received_utime,
           std::int64_t now_us);

  // The table, a heading first; at most so many rows, and a line that says how many are left out.
  std::string text(std::size_t max_rows, std::int64_t now_us);

 private:
  struct Row {
    marker_t marker{};
    std::int64_t seen_us = 0;
    int frames = 0;   // in this period
    double rate = 0;  // in the last one, frames a second
  };

  void end_period(std::int64_t now_us);
  std::string heading() const;

  std::vector<Row> rows_;  // by id (unknown last), then by track
  header_t header_{};
  std::string camera_;
  ReceptionCounts counts_;
  double latency_ms_ = 0;
  double rate_ = 0;
  int frames_ = 0;  // in this period
  int periods_ = 0;
  std::int64_t period_start_us_ = 0;
};

}  // namespace roundel
