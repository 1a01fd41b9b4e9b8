#include "simulator/coverage.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace roundel {

namespace {

// Integral of clamp(t, 0, 1): the mean of a cell's share right of a sloped edge is a difference of
// it.
double ramp_integral(double t) {
  return t <= 0 ? 0 : t < 1 ? 0.5 * t * t : t - 0.5;
}

}  // namespace

void CoverageGrid::reset(int width, int height) {
  width_ = width;
  height_ = height;
  stride_ = width + 2;  // an edge in the last cell changes the one after it
  changes_.assign(static_cast<std::size_t>(stride_) * static_cast<std::size_t>(height), 0.0F);
}

void CoverageGrid::begin(double weight) {
  weight_ = weight;
  open_ = false;
}

void CoverageGrid::add(const Eigen::Vector2d& point) {
  if (open_) {
    edge(last_, point);
  } else {
    first_ = point;
    open_ = true;
  }
  last_ = point;
}

void CoverageGrid::end() {
  if (open_) edge(last_, first_);
  open_ = false;
}

void CoverageGrid::edge(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  // Clockwise on the screen, the left side of an outline runs upward.
  double x0 = from.x(), y0 = from.y(), x1 = to.x(), y1 = to.y();
  double sign = -weight_;
  if (y0 > y1) {
    std::swap(x0, x1);
    std::swap(y0, y1);
    sign = weight_;
  }
  if (y1 <= 0 || y0 >= height_ || y0 == y1) return;
  const double slope = (x1 - x0) / (y1 - y0);
  const double top = std::max(y0, 0.0), bottom = std::min(y1, static_cast<double>(height_));
  const int last_row = std::min(height_ - 1, static_cast<int>(bottom));
  double y = top, x = x0 + slope * (top - y0);
  for (int j = static_cast<int>(top); j <= last_row; ++j) {
    const double next_y = std::min(j + 1.0, bottom);
    if (next_y <= y) continue;
    const double next_x = next_y == y1 ? x1 : x0 + slope * (next_y - y0);
    segment(changes_.data() + static_cast<std::ptrdiff_t>(j) * stride_, x, next_x,
            sign * (next_y - y));
    x = next_x;
    y = next_y;
  }
}

// An edge's piece within one row: all cells right of it gain `height`, those it crosses a share.
void CoverageGrid::segment(float* row, double x0, double x1, double height) const {
  const double left = std::min(x0, x1), right = std::max(x0, x1);
  if (left >= width_) return;
  if (right <= 0) {
    row[0] += static_cast<float>(height);
    return;
  }
  const int begin = std::max(0, static_cast<int>(left));
  if (left >= 0 && right <= begin + 1) {  // the common case: within one cell
    const double share = height * (begin + 1 - 0.5 * (left + right));
    row[begin] += static_cast<float>(share);
    row[begin + 1] += static_cast<float>(height - share);
    return;
  }
  const int end = std::min(width_ - 1, static_cast<int>(right));
  const double scale = height / (right - left);
  double previous = 0;
  for (int i = begin; i <= end; ++i) {
    const double share = scale * (ramp_integral(i + 1 - left) - ramp_integral(i + 1 - right));
    row[i] += static_cast<float>(share - previous);
    previous = share;
  }
  row[end + 1] += static_cast<float>(height - previous);
}

}  // namespace roundel
