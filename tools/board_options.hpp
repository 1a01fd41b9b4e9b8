#pragma once

#include <CLI/CLI.hpp>

#include "calibration/board.hpp"

namespace roundel {

// --columns, --rows, --spacing, --bits, --hamming of a board that has been printed. Its size does
// not matter to a camera calibration, nor does that of the markers.
void add_board_options(CLI::App& command, Board& board);

// The board with markers of the usual size; UsageError if it can't be.
Board checked_board(Board board);

}  // namespace roundel
