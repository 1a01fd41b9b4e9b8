#pragma once

#include <nlohmann/json.hpp>

#include "simulator/truth.hpp"

namespace roundel {

// One line of the truth file of `roundel simulate`: frame, utime (microseconds from the first
// frame), and all markers, also those that can't be seen. `visible`: nothing keeps a detector from
// finding it.
nlohmann::ordered_json truth_json(const FrameTruth& truth);

// Reads it back, but for the arena coordinates. Throws std::runtime_error that names the field that
// is missing or wrong.
FrameTruth truth_from_json(const nlohmann::ordered_json& json);

}  // namespace roundel
