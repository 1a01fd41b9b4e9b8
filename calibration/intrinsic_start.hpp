#pragma once

#include <optional>
#include <span>
#include <vector>

#include "calibration/intrinsic_view.hpp"
#include "core/camera_model.hpp"
#include "core/pose.hpp"

namespace roundel {

// A camera about which nothing is known but its picture's size: a common field of view, the
// principal point in the middle, no distortion.
CameraModel guessed_camera(int width, int height);

// Focal length of a camera with square pixels, the principal point in the picture's middle and no
// distortion: a board's rows and columns are orthogonal and equally spaced, which a homography
// betrays in a tilted view (Zhang 2000). Nothing if the views say nothing or nonsense.
std::optional<double> focal_from_homographies(std::span<const BoardView> views, int width,
                                              int height);

// The board's pose as a camera sees it. Nothing if points are too few or the lens model ends.
std::optional<Pose> board_pose(const BoardView& view, const CameraModel& camera);

}  // namespace roundel
