#include "daemon/service/service_status.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace roundel {
namespace {

std::string_view words(CalibrationState state) {
  switch (state) {
    case CalibrationState::kValid:
      return "lens calibrated";
    case CalibrationState::kOtherResolution:
      return "lens calibrated at another resolution: no poses";
    default:
      return "lens not calibrated: no poses";
  }
}

std::string_view words(ArenaState state) {
  switch (state) {
    case ArenaState::kValid:
      return "arena calibrated";
    case ArenaState::kOtherCamera:
      return "the arena calibration on file is not used";
    case ArenaState::kMoved:
      return "the camera has been moved since the arena was calibrated";
    default:
      return "arena not calibrated";
  }
}

}  // namespace

void write_status(const ServiceStatus& status, fmt::memory_buffer& text) {
  const auto add = [&](auto format, const auto&... values) {
    fmt::format_to(std::back_inserter(text), format, values...);
  };
  text.clear();
  if (status.camera == CameraState::kStreaming) {
    add(FMT_STRING("Tracking "));
    if (status.frame_rate > 0) add(FMT_STRING("{:.0f} frames/s from "), status.frame_rate);
    add(FMT_STRING("{}; {}; {}"), status.source, words(status.calibration), words(status.arena));
  } else if (status.camera == CameraState::kLost) {
    add(FMT_STRING("Lost the camera, waits for it: {}"), status.waits_because);
  } else if (status.camera == CameraState::kEnded) {
    add(FMT_STRING("At the end of {}"), status.source);
  } else if (status.waits_because.empty()) {
    add(FMT_STRING("Starting: {}"), status.source);
  } else {
    add(FMT_STRING("Waits for the camera: {}"), status.waits_because);
  }
  if (!status.network) add(FMT_STRING("; no network for poses to {} yet"), status.url);
  if (!status.reload_error.empty()) {
    add(FMT_STRING("; the last reload failed: {}"), status.reload_error);
  }
}

double SteadyRate::steady(double rate) {
  constexpr double kNearly = 0.05, kNearlyPerSecond = 1;
  if (std::abs(rate - shown_) > std::max(kNearlyPerSecond, kNearly * rate)) shown_ = rate;
  return shown_;
}

}  // namespace roundel
