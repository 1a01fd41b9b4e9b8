#pragma once

#include <fmt/format.h>

#include <string_view>

#include "transport/frame_information.hpp"

namespace roundel {

// What `systemctl status` shows of a running roundeld in one line.
struct ServiceStatus {
  CameraState camera = CameraState::kStarting;
  CalibrationState calibration = CalibrationState::kNone;
  ArenaState arena = ArenaState::kNone;
  double frame_rate = 0;
  std::string_view source;         // where frames come from
  std::string_view waits_because;  // no frames come
  bool network = true;             // poses can be sent
  std::string_view url;            // to where
  std::string_view reload_error;   // of the last reload; empty: it went well
};

void write_status(const ServiceStatus& status, fmt::memory_buffer& text);

// A frame rate that stays as it is for as long as it is nearly right, so that a status which holds
// it does not change every second.
class SteadyRate {
 public:
  double steady(double rate);

 private:
  double shown_ = 0;
};

}  // namespace roundel
