#pragma once

#include <CLI/CLI.hpp>

#include "calibration/board.hpp"

namespace roundel {

// --columns, --rows, --spacing, --diameter, --bits, --hamming of a board that has been printed. The
// size of the print does not matter to a camera calibration, only the diameter's ratio to the
// spacing, so a board at another scale needs none of them.
void add_board_options(CLI::App& command, Board& board);

// The board if it can be; otherwise UsageError.
const Board& checked_board(const Board& board);

}  // namespace roundel
