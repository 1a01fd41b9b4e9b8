#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "config/configuration.hpp"
#include "tools/doctor/finding.hpp"

namespace roundel {

// The camera's intrinsics: there, readable, for the frames' size (0: not known), and how old.
Finding check_lens(const Configuration& values, int width, int height,
                   std::chrono::system_clock::time_point now);

// The arena's calibration: there, readable, for the same intrinsics, and how old.
Finding check_arena(const Configuration& values);

}  // namespace roundel
