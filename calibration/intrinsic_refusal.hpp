#pragma once

#include <span>

#include "calibration/board.hpp"
#include "calibration/board_detector.hpp"
#include "calibration/intrinsic_calibration.hpp"
#include "calibration/intrinsic_view.hpp"

namespace roundel {

// What makes a calibration impossible or worthless. Each throws std::runtime_error with a sentence
// that says what is missing and what to do; nothing happens if all is well.

// What pictures showed of the board, counted.
struct BoardTally {
  int pictures = 0, views = 0;  // views: pictures that show enough of the board
  int markers = 0;              // with ids of the board
  int foreign = 0;              // with other ids
  int misplaced = 0;            // of `markers`: not where the board has them

  void add(const BoardSighting& sighting);
};

// Why not one picture is a view of the board.
void require_board(const BoardTally& tally, const Board& board);

// Before the adjustment: number of views with enough markers, and where in the picture they were.
// `pictures` is how many there were at first.
void require_views(std::span<const BoardView> views, std::size_t pictures, int width, int height);

// After outliers have been left out: how many views are left of how many.
void require_agreement(std::size_t left, std::size_t views);

// After it: tilts, size of the residuals, deviations of the focal length, reach of the lens model.
void require_determined(const IntrinsicCalibration& calibration);

}  // namespace roundel
