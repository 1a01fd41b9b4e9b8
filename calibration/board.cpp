#include "calibration/board.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "core/necklace.hpp"

namespace roundel {
namespace {

constexpr int kMinSide = 2;
constexpr int kMinMarkers = 6;              // fewer say too little about a view
constexpr int kMaxMarkers = 200;            // the adjustment's time grows with the cube
constexpr double kMaxDiameterRatio = 0.83;  // of the spacing; closer markers flow together

[[noreturn]] void refuse(const std::string& what) {
  throw std::invalid_argument(what);
}

}  // namespace

Eigen::Vector2d Board::centre_of(int id) const {
  const int column = (id - 1) % columns, row = (id - 1) / columns;
  return {spacing_m * (column - 0.5 * (columns - 1)), spacing_m * (0.5 * (rows - 1) - row)};
}

const Board& checked(const Board& board) {
  if (board.columns < kMinSide || board.columns > kMaxMarkers || board.rows < kMinSide ||
      board.rows > kMaxMarkers || board.count() < kMinMarkers || board.count() > kMaxMarkers) {
    refuse(
        fmt::format("a board has at least {0} columns and {0} rows, and {1} to {2} markers; not "
                    "{3} x {4}",
                    kMinSide, kMinMarkers, kMaxMarkers, board.columns, board.rows));
  }
  if (!(board.diameter_m > 0) || !std::isfinite(board.spacing_m)) {
    refuse("diameter and spacing of a board must be positive");
  }
  if (!(board.diameter_m <= kMaxDiameterRatio * board.spacing_m)) {
    refuse(
        fmt::format("markers of {:.4g} m at a spacing of {:.4g} m leave no white margin between "
                    "them: at most {:.4g} m",
                    board.diameter_m, board.spacing_m, kMaxDiameterRatio * board.spacing_m));
  }
  const int ids = NecklaceCode(board.bits, board.hamming).id_count();
  if (board.count() > ids) {
    refuse(
        fmt::format("a board of {} x {} needs {} ids, but the set of {} bits has {}: use more "
                    "--bits, or fewer --columns or --rows",
                    board.columns, board.rows, board.count(), board.bits, ids));
  }
  return board;
}

}  // namespace roundel
