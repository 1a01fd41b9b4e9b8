#pragma once

#include <string>

#include "daemon/control/frame_snapshot.hpp"

namespace roundel {

enum class PictureFormat { kJpeg, kPng, kPgm };

// The frame's picture as a file: with the found markers, ids, axes, the arena's grid and corners
// drawn in, or plain. PGM, which is grey, is always plain: the pixels as they were tracked. Throws
// std::runtime_error.
std::string encode_picture(const FrameSnapshot& frame, PictureFormat format, bool overlay);

}  // namespace roundel
