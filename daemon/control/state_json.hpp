#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "daemon/control/arena_service.hpp"
#include "daemon/control/frame_snapshot.hpp"

namespace roundel {

// What the control socket answers (docs/guide/arena.md). Fields may be added, never renamed or
// dropped.
nlohmann::ordered_json status_json(const status_t& status, const TrackingContext* context,
                                   const std::string& watch_text);
nlohmann::ordered_json markers_json(const FrameSnapshot& frame);
nlohmann::ordered_json calibration_json(const TrackingContext* context,
                                        const CalibrationProgress& progress,
                                        const std::string& watch_text);

// The body of POST /v1/calibration/arena. Throws std::runtime_error that names the field.
ArenaRequest arena_request_from_json(const nlohmann::ordered_json& json);

}  // namespace roundel
