#include "calibration/picture_coverage.hpp"

#include <algorithm>

namespace roundel {
namespace {

constexpr double kBorder = 0.22;  // depth of the regions along the border, share of the side
constexpr std::array<const char*, PictureCoverage::kRegions> kNames = {
    "upper left", "top",        "upper right", "left",       "middle",
    "right",      "lower left", "bottom",      "lower right"};

std::size_t third(double at, int side) {
  const double share = (at + 0.5) / side;
  return share < kBorder ? 0 : share > 1 - kBorder ? 2 : 1;
}

}  // namespace

void PictureCoverage::add(const BoardView& view) {
  for (const BoardPoint& point : view.points)
    ++points_[3 * third(point.pixel.y(), height_) + third(point.pixel.x(), width_)];
}

std::size_t PictureCoverage::covered() const {
  return static_cast<std::size_t>(
      std::count_if(points_.begin(), points_.end(), [](int count) { return count > 0; }));
}

std::vector<std::string> PictureCoverage::missing() const {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < kRegions; ++i) {
    if (points_[i] == 0) names.emplace_back(kNames[i]);
  }
  return names;
}

PictureCoverage coverage_of(std::span<const BoardView> views, int width, int height) {
  PictureCoverage coverage(width, height);
  for (const BoardView& view : views) coverage.add(view);
  return coverage;
}

std::string listed(std::span<const std::string> words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 == words.size() ? " and " : ", ";
    text += words[i];
  }
  return text;
}

}  // namespace roundel
