#pragma once

#include <Eigen/Core>
#include <vector>

namespace roundel {

// Exact area coverage of closed polygons on a grid of unit cells; cell (i, j) covers
// [i, i+1] x [j, j+1]. Every edge adds, row by row, the change of the covered area from one cell to
// the next; a running sum along the row then gives the coverage. Contours add up: weights make a
// picture of several levels, or the mean over several places of a moving outline, at one cost.
class CoverageGrid {
 public:
  // An empty grid. Storage is kept.
  void reset(int width, int height);

  int width() const { return width_; }
  int height() const { return height_; }

  // Closed contours, one at a time: begin, points, end. A contour that runs clockwise on the screen
  // (x right, y down) adds `weight` times its coverage, the other sense subtracts it. Parts outside
  // of the grid are cut off exactly.
  void begin(double weight);
  void add(const Eigen::Vector2d& point);
  void end();

  // Changes along row j whose running sum is the coverage; width() + 1 values.
  const float* row(int j) const {
    return changes_.data() + static_cast<std::ptrdiff_t>(j) * stride_;
  }

 private:
  void edge(const Eigen::Vector2d& from, const Eigen::Vector2d& to);
  void segment(float* row, double x0, double x1, double height) const;

  int width_ = 0, height_ = 0, stride_ = 0;
  std::vector<float> changes_;
  double weight_ = 0;
  bool open_ = false;
  Eigen::Vector2d first_, last_;
};

}  // namespace roundel
