#include "tools/board_options.hpp"

#include <stdexcept>

#include "tools/commands.hpp"

namespace roundel {

void add_board_options(CLI::App& command, Board& board) {
  command.add_option("--columns", board.columns, "Of the board")->capture_default_str();
  command.add_option("--rows", board.rows, "Of the board")->capture_default_str();
  command
      .add_option(
          "--spacing", board.spacing_m,
          "Between the centres of neighbours, metres; the camera does not depend on it, but "
          "what is said about the print does")
      ->check(CLI::Range(1e-4, 10.0))
      ->type_name("METRES")
      ->capture_default_str();
  command.add_option("--bits", board.bits, "WhyCode bits, 2 to 16")->capture_default_str();
  command.add_option("--hamming", board.hamming, "Minimum Hamming distance of the set, 1 to 4")
      ->capture_default_str();
}

Board checked_board(Board board) {
  try {
    board.diameter_m = kBoardDiameterRatio * board.spacing_m;
    return checked(board);
  } catch (const std::invalid_argument& error) {
    throw UsageError(error.what());
  }
}

}  // namespace roundel
