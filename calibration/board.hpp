#pragma once

#include <Eigen/Core>
#include <vector>

namespace roundel {

// A printed sheet of WhyCode markers in a grid, which a camera is calibrated with. Everything about
// it follows from these few numbers, so a calibration is told the same as the printer was.
// Board frame: origin in the middle of the grid, x along the rows to the right of the page, y up
// the page, z out of the printed face; metres. The markers' own axes are parallel to the board's.
// Ids rise by one from 1, row by row from the top left.
struct Board {
  int columns = 7, rows = 4;
  double spacing_m = 0.040;   // between the centres of neighbours, both ways
  double diameter_m = 0.030;  // outer black diameter of a marker
  int bits = 8, hamming = 1;  // of the code

  int count() const { return columns * rows; }
  bool has(int id) const { return id >= 1 && id <= count(); }

  // Where the centre of a marker lies, in the plane of the board; has(id).
  Eigen::Vector2d centre_of(int id) const;
};

// Markers of this share of the spacing leave each other a white margin.
inline constexpr double kBoardDiameterRatio = 0.75;

// The board if it can be printed and calibrated with; otherwise std::invalid_argument that says
// what is wrong and what would be right.
const Board& checked(const Board& board);

}  // namespace roundel
