#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "config/configuration.hpp"
#include "tools/doctor/finding.hpp"

namespace roundel {

// What a running roundeld says of itself (GET /v1/status): its camera, the frame rate reached,
// frames left out and not sent, the arena. Throws std::runtime_error for what is no status.
std::vector<Finding> check_status(const nlohmann::ordered_json& status,
                                  const Configuration& values);

}  // namespace roundel
