#pragma once

#include <Eigen/Core>
#include <span>

#include "calibration/board.hpp"

namespace roundel {

// How well a printed board is what it should be, at its nominal size.
struct PrintQuality {
  double off_m = 0;  // of the markers in the plane, root mean square, without scale, shift and turn
  double stretch = 0;     // how much longer the print is along y than along x, relative
  double flatness_m = 0;  // between the highest and the lowest marker, without tilt
};

// Of the markers' estimated offsets by id - 1; zeros if there are none.
PrintQuality print_quality(const Board& board, std::span<const Eigen::Vector3d> offsets);

}  // namespace roundel
