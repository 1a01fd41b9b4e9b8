#pragma once

#include <span>
#include <string>

#include "core/marker.hpp"
#include "daemon/json_frame.hpp"

namespace roundel {

// A frame for human eyes: one line a marker, each with its end; one line where there is none.
std::string frame_text(const FrameInfo& info, std::span<const Marker> markers,
                       std::span<const ArenaPose> arena = {});

}  // namespace roundel
