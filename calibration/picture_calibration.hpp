#pragma once

#include <span>

#include "calibration/board.hpp"
#include "calibration/intrinsic_calibration.hpp"
#include "core/luma_view.hpp"

namespace roundel {

// Pictures of the board, all of one size. They must outlive the calibration.
using Pictures = std::span<const LumaView>;

struct PictureCalibration {
  IntrinsicCalibration result;
  int rounds = 0;             // of detection
  double last_change_px = 0;  // by which the last round moved the image of any place
};

// Calibrates a camera of which nothing is known from pictures of a board: detects with a guess,
// calibrates, detects again with the camera found, until it settles. Throws std::runtime_error with
// a sentence for the user. The options' spacing is the board's.
PictureCalibration calibrate_from_pictures(Pictures pictures, const Board& board,
                                           IntrinsicOptions options);

}  // namespace roundel
