#pragma once

#include <vector>

namespace roundel {

// The lens's Gaussian blur together with the sensor's pixels. Scenes are drawn on a grid `factor`
// times finer than the pixels, because a blurred edge's grey depends on where within the pixel it
// lies; filter() blurs and sums fine cells to pixels in one pass. Total light is kept.
class Optics {
 public:
  explicit Optics(double blur_px);

  int factor() const { return factor_; }
  int margin() const { return margin_; }  // pixels of scene needed around a piece of picture

  // fine: (height + 2 margin) * factor rows of (width + 2 margin) * factor cells.
  // pixels: height rows of width. Scratch grows to the largest size seen.
  void filter(const std::vector<float>& fine, int width, int height, std::vector<float>& pixels);

 private:
  template <int Columns>
  void sum_down(const float* top, int stride, float* sums) const;

  int factor_ = 1;
  int margin_ = 0;
  std::vector<float> taps_;
  std::vector<float> rows_;  // blurred down the columns: one row of fine cells
};

}  // namespace roundel
