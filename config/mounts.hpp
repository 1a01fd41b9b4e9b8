#pragma once

#include <optional>
#include <string>

#include "calibration/arena_map.hpp"
#include "config/configuration.hpp"

namespace roundel {

// An entry of marker.mounts, "7 height=0.12 offset_x=0.01 offset_y=0 rotation=1.57": an id and what
// differs from the usual mount. Nothing if it is not of that form or out of range.
std::optional<IdMount> parse_mount(const std::string& text, const MarkerMount& usual);

// How robots wear their markers. The entries must be valid (the reader sees to it).
MarkerMounts marker_mounts(const MountSettings& settings);

}  // namespace roundel
