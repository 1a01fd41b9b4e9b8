#pragma once

#include <vector>

namespace roundel::bench {

// A printed square tag: `cells` x `cells` equal squares, black border included, row by row from the
// page's top left. The tag's x axis points right on the page, y up.
struct SquarePattern {
  int cells = 0;
  std::vector<bool> white;

  bool is_white(int column, int row) const {
    return white[static_cast<std::size_t>(row * cells + column)];
  }
};

}  // namespace roundel::bench
