#pragma once

#include "core/camera_model.hpp"
#include "core/pose.hpp"
#include "simulator/arena_options.hpp"

namespace roundel {

// The arena frame in the frame of a camera above the arena's middle that looks down at it; with
// neither tilt nor turn, arena x is the image's right and arena y its up.
Pose arena_in_ceiling_camera(const ArenaOptions& options);

// A webcam's lens, of METHOD.md section 9's focal length scaled to the image; shorter where the
// arena's markers would not all be in the picture. The options' own camera, if there is one.
// Throws std::invalid_argument when no lens shows the whole arena.
CameraModel arena_camera(const ArenaOptions& options, const Pose& arena_in_camera);

}  // namespace roundel
