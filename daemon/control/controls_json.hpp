#pragma once

#include <nlohmann/json.hpp>

#include "daemon/capture/camera_controls.hpp"

namespace roundel {

nlohmann::ordered_json control_json(const Control& control);

// Names and values that PUT /v1/controls asks for: numbers, booleans or text. Throws
// std::runtime_error that names the field.
ControlValues control_values_from_json(const nlohmann::ordered_json& json);

}  // namespace roundel
