#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace roundel {

// The names of the columns, which end with their units, with the end of the line.
std::string pose_csv_heading();

// A frame's object (DESIGN.md section 4) as rows, one a marker, or one with empty fields for a
// frame without any. Numbers are written as they were. Throws std::runtime_error that names the
// field that is missing or wrong.
std::string pose_csv_rows(const nlohmann::ordered_json& frame);

}  // namespace roundel
