#pragma once

#include <cairo.h>

#include <string>

#include "calibration/board.hpp"
#include "tools/sheet_layout.hpp"

namespace roundel {

// The largest board of so many markers on a paper (A4, A3, Letter): spacing in whole millimetres,
// its usual ratio to the diameter. Throws std::invalid_argument where markers would be too small to
// print.
Board largest_board(const std::string& paper, const Board& like);

// How a board lies on the paper, upright or across. Throws std::invalid_argument, with the largest
// spacing that would do, if it does not fit.
SheetLayout lay_out_board(const std::string& paper, const Board& board);

// The board with a ruler and the command that calibrates with it. Millimetres.
void draw_board_sheet(cairo_t* context, const SheetLayout& layout, const Board& board);

}  // namespace roundel
