#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "tools/track_statistics.hpp"

namespace roundel {

// What `roundel compare` prints: a table for human eyes, and one object for scripts (fields may be
// added, never renamed or dropped; null where there is nothing to tell).
std::string comparison_text(const TrackStatistics& statistics);
nlohmann::ordered_json comparison_json(const TrackStatistics& statistics);

}  // namespace roundel
