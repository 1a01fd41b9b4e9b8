#pragma once

#include <nlohmann/json.hpp>

#include "config/configuration.hpp"
#include "daemon/control/recording_queue.hpp"

namespace roundel {

// What is told once about a recording: version, frame rate, and as texts of files what it takes to
// play it: "configuration", "camera" and "arena" (the latter two only where there are such).
nlohmann::ordered_json recording_json(const FrameSnapshot& frame,
                                      const Configuration& configuration, double frame_rate,
                                      bool restart);

// The frame's object (DESIGN.md section 4), with the times, counts and the size of its picture.
nlohmann::ordered_json recorded_frame_json(const RecordingQueue::Entry& entry);

}  // namespace roundel
