#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "calibration/intrinsic_view.hpp"

namespace roundel {

// In which of nine regions of the picture (corners, sides, middle) markers of the board have been
// seen. The corners are small, because that is where a lens bends most and is known least.
class PictureCoverage {
 public:
  static constexpr std::size_t kRegions = 9;

  PictureCoverage(int width, int height) : width_(width), height_(height) {}

  void add(const BoardView& view);

  std::size_t covered() const;
  // "upper left", "top", ...; row by row.
  std::vector<std::string> missing() const;

 private:
  int width_, height_;
  std::array<int, kRegions> points_{};
};

PictureCoverage coverage_of(std::span<const BoardView> views, int width, int height);

// "a", "a and b", "a, b and c".
std::string listed(std::span<const std::string> words);

}  // namespace roundel
