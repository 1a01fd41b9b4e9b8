#pragma once

#include <optional>
#include <stdexcept>
#include <string>

#include "core/camera_model.hpp"
#include "core/luma_view.hpp"

namespace roundel {

// Intrinsics belong to one resolution: with another one every metric pose would be wrong without a
// sign of it (NEEDS.md 15). Throws std::invalid_argument.
inline void check_frame(const LumaView& frame, const std::optional<CameraModel>& camera) {
  if (frame.empty()) throw std::invalid_argument("the frame has no pixels");
  if (camera && (camera->width != frame.width || camera->height != frame.height)) {
    throw std::invalid_argument("the camera calibration is for " + std::to_string(camera->width) +
                                "x" + std::to_string(camera->height) + " pixels, the frame has " +
                                std::to_string(frame.width) + "x" + std::to_string(frame.height));
  }
}

}  // namespace roundel
