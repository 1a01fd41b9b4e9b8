#pragma once

#include <span>
#include <vector>

#include "calibration/bundle_adjustment.hpp"
#include "calibration/noise_floor.hpp"

namespace roundel {

// Residuals of adjusted views as large as the noise that made them. An adjustment bends towards its
// points, and most towards those that it trusts most: what is left over of them is too small, by
// what they determined of the unknowns (their leverage). Each is stretched by that much: its
// expected square is then that of its noise, if the weights were right. Empty if the views do not
// determine the unknowns.
std::vector<NoisyResidual> free_residuals(std::span<const BoardView> views,
                                          const BundleState& state, const BundleOptions& options);

}  // namespace roundel
