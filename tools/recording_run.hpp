#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string>

#include "tools/control_client.hpp"

namespace roundel {

// When a recording ends, and how it begins.
struct RecordingLimits {
  double seconds = std::numeric_limits<double>::infinity();
  std::int64_t frames = std::numeric_limits<std::int64_t>::max();
  bool keep_tracks = false;  // tracking is not begun anew for it
};

// Records what a running roundeld sees into a new folder (recording_folder.hpp), until the limits
// or `go_on` say that it is enough. Returns what there is to tell about it, in lines. Throws
// std::runtime_error; what has been recorded until then is whole, and is told on standard error.
std::string run_recording(const ControlClient& client, const std::string& path,
                          const RecordingLimits& limits, const std::function<bool()>& go_on);

}  // namespace roundel
