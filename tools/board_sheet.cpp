#include "tools/board_sheet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/necklace.hpp"
#include "tools/marker_pattern.hpp"
#include "tools/sheet_foot.hpp"

namespace roundel {
namespace {

constexpr double kMinSpacingMm = 8;  // less, and no printer draws the code

// Largest cell of a grid that fits, over both ways of holding the paper.
double largest_cell_mm(const std::string& paper, const Board& board) {
  const PageSize upright = paper_size(paper);
  const PageSize across = {upright.height_mm, upright.width_mm};
  return std::max(largest_cell(upright, board.columns, board.rows),
                  largest_cell(across, board.columns, board.rows));
}

}  // namespace

Board largest_board(const std::string& paper, const Board& like) {
  const double spacing_mm = std::floor(largest_cell_mm(paper, like) + 1e-9);
  if (spacing_mm < kMinSpacingMm) {
    throw std::invalid_argument(
        fmt::format("{} x {} markers are too many for {}", like.columns, like.rows, paper));
  }
  Board board = like;
  board.spacing_m = spacing_mm / 1000;
  board.diameter_m = kBoardDiameterRatio * board.spacing_m;
  return board;
}

SheetLayout lay_out_board(const std::string& paper, const Board& board) {
  const double spacing_mm = 1000 * board.spacing_m;
  const double room = largest_cell_mm(paper, board);
  if (spacing_mm > room + 1e-9) {
    throw std::invalid_argument(fmt::format(
        "{} x {} markers at a spacing of {:.4g} m do not fit {}: at most {:.4g} m", board.columns,
        board.rows, board.spacing_m, paper, std::floor(10 * room) / 10000));
  }
  const PageSize upright = paper_size(paper);
  const bool fits = spacing_mm <= largest_cell(upright, board.columns, board.rows) + 1e-9;
  return lay_out_grid(fits ? upright : PageSize{upright.height_mm, upright.width_mm}, board.columns,
                      board.rows, spacing_mm);
}

void draw_board_sheet(cairo_t* context, const SheetLayout& layout, const Board& board) {
  const NecklaceCode code(board.bits, board.hamming);
  // The board's origin on the page, whose y points down.
  const double middle_x = layout.left_mm + 0.5 * layout.columns * layout.cell_mm;
  const double middle_y = layout.top_mm + 0.5 * layout.rows * layout.cell_mm;
  for (int id = 1; id <= board.count(); ++id) {
    const Eigen::Vector2d at = 1000 * board.centre_of(id);
    draw_marker(context, {board.bits, code.word(id).value(), 0}, middle_x + at.x(),
                middle_y - at.y(), 500 * board.diameter_m);
  }
  draw_sheet_foot(
      context, layout, "Glue it to something flat and stiff. Its size does not matter.",
      fmt::format("roundel calibrate camera --columns {} --rows {} --spacing {:.6g} --bits {}{} -o "
                  "camera.yaml PICTURES",
                  board.columns, board.rows, board.spacing_m, board.bits,
                  board.hamming > 1 ? fmt::format(" --hamming {}", board.hamming) : ""));
}

}  // namespace roundel
