#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "calibration/intrinsic_view.hpp"
#include "core/camera_model.hpp"

namespace roundel {

// As many as a good calibration wants.
inline constexpr std::size_t kGoodViews = 15;

// What the views of a board lack for a good calibration, as things to do: parts of the picture
// where it was not seen, sides that were not tilted toward the camera, a turn, size. Empty when
// nothing is missing. The camera may be a guess.
std::vector<std::string> view_advice(std::span<const BoardView> views, const CameraModel& camera);

}  // namespace roundel
