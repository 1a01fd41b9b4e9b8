#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace roundel {

// A calibration of the arena in words: certainty, and what every fixed marker and side is off, in
// millimetres. Of the "arena" object of GET /v1/calibration.
std::string arena_report(const nlohmann::ordered_json& arena);

}  // namespace roundel
