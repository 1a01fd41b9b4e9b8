#pragma once

#include <string>

#include "daemon/control/frame_snapshot.hpp"

namespace roundel {

enum class PictureFormat { kJpeg, kPng };

// The frame's picture as a file: with the found markers, ids, axes, the arena's grid and corners
// drawn in, or plain. Throws std::runtime_error.
std::string encode_picture(const FrameSnapshot& frame, PictureFormat format, bool overlay);

}  // namespace roundel
