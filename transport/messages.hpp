#pragma once

#include <roundel/frame_t.hpp>
#include <roundel/pose_t.hpp>
#include <roundel/status_t.hpp>

#include "core/arena_pose.hpp"
#include "core/marker.hpp"
#include "transport/frame_information.hpp"

namespace roundel {

// Between the core's types and the generated LCM types. No allocation.
header_t to_message(const FrameInformation& information);
marker_t to_message(const Marker& marker, const ArenaPose& arena = {});

Marker from_message(const marker_t& message);
ArenaPose arena_from_message(const marker_t& message);

}  // namespace roundel
