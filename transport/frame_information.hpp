#pragma once

#include <cstdint>

#include "transport/clock.hpp"

namespace roundel {

// What is known about a frame besides its markers. The meaning of every value is explained in
// transport/lcm/header_t.lcm; the enumerators are the constants there.

enum class StampSource : std::int8_t {
  kUnknown = 0,
  kMiddleOfExposure = 1,
  kStartOfFrame = 2,
  kEndOfFrame = 3,
  kArrival = 4,
};
enum class ClockState : std::int8_t { kUnknown = 0, kSynchronised = 1, kFreeRunning = 2 };
enum class CameraState : std::int8_t { kStarting = 0, kStreaming = 1, kLost = 2, kEnded = 3 };
enum class CalibrationState : std::int8_t { kNone = 0, kValid = 1, kOtherResolution = 2 };
enum class ArenaState : std::int8_t { kNone = 0, kValid = 1, kOtherCamera = 2, kMoved = 3 };
enum class ArenaModeCode : std::int8_t { kNone = 0, k2D = 2, k3D = 3 };

struct FrameInformation {
  std::int64_t session = 0;
  std::int64_t frame = 0;
  std::int64_t dropped = 0;
  TimeStamp captured;
  TimeStamp published;  // set by Publisher
  double tracking_us = 0;
  int width = 0, height = 0;
  StampSource stamp_source = StampSource::kUnknown;
  ClockState clock = ClockState::kUnknown;
  CameraState camera = CameraState::kStarting;
  CalibrationState calibration = CalibrationState::kNone;
  ArenaState arena = ArenaState::kNone;
  ArenaModeCode arena_mode = ArenaModeCode::kNone;
  bool simulated = false;
};

}  // namespace roundel
