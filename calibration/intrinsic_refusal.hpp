#pragma once

#include <span>

#include "calibration/intrinsic_calibration.hpp"
#include "calibration/intrinsic_view.hpp"

namespace roundel {

// What makes a calibration impossible or worthless. Each throws std::runtime_error with a sentence
// that says what is missing and what to do; nothing happens if all is well.

// Before the adjustment: number of views with enough markers, and where in the picture they were.
void require_views(std::span<const BoardView> views, int width, int height);

// After it: tilts, size of the residuals, deviations of the focal length.
void require_determined(const IntrinsicCalibration& calibration);

}  // namespace roundel
