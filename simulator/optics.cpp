#include "simulator/optics.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace roundel {

namespace {

constexpr double kMaxBlur = 10;  // pixels
constexpr double kCutoff = 4;    // standard deviations
constexpr int kBlock = 16;       // columns blurred together
// Between cells the blurred edge is a straight line instead of a curve; with so many cells this is
// below 0.4 % of the contrast.
constexpr double kCellsPerSigma = 2.08;
constexpr int kMaxFactor = 6;

}  // namespace

Optics::Optics(double blur_px) {
  if (!(blur_px >= 0 && blur_px <= kMaxBlur)) {
    throw std::invalid_argument("blur_px is " + std::to_string(blur_px) +
                                " pixels; it must lie between 0 and 10");
  }
  if (blur_px == 0) {
    taps_ = {1.0F};
    return;
  }
  factor_ = std::clamp(static_cast<int>(std::ceil(kCellsPerSigma / blur_px)), 1, kMaxFactor);
  const double sigma = blur_px * factor_;
  const int reach = std::max(1, static_cast<int>(std::ceil(kCutoff * sigma)));
  margin_ = (reach + factor_ - 1) / factor_;

  std::vector<double> gauss;
  double sum = 0;
  for (int k = -reach; k <= reach; ++k) {
    gauss.push_back(std::exp(-0.5 * k * k / (sigma * sigma)));
    sum += gauss.back();
  }
  // A pixel is the mean of its `factor` cells.
  std::vector<double> taps(gauss.size() + static_cast<std::size_t>(factor_) - 1, 0.0);
  for (std::size_t k = 0; k < gauss.size(); ++k) {
    for (int cell = 0; cell < factor_; ++cell) {
      taps[k + static_cast<std::size_t>(cell)] += gauss[k] / (sum * factor_);
    }
  }
  taps_.assign(taps.begin(), taps.end());
}

// Blurs `Columns` neighbouring columns, with the sums held in registers.
template <int Columns>
void Optics::sum_down(const float* top, int stride, float* sums) const {
  float sum[Columns] = {};
  for (const float tap : taps_) {
    for (int i = 0; i < Columns; ++i) sum[i] += tap * top[i];
    top += stride;
  }
  std::copy_n(sum, Columns, sums);
}

void Optics::filter(const std::vector<float>& fine, int width, int height,
                    std::vector<float>& pixels) {
  const int fine_width = (width + 2 * margin_) * factor_;
  const int count = static_cast<int>(taps_.size());
  const int start = margin_ * factor_ - (count - factor_) / 2;
  pixels.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  rows_.resize(static_cast<std::size_t>(fine_width));
  for (int v = 0; v < height; ++v) {
    const float* top = fine.data() + static_cast<std::ptrdiff_t>(v * factor_ + start) * fine_width;
    float* sums = rows_.data();
    int i = 0;
    for (; i + kBlock <= fine_width; i += kBlock) sum_down<kBlock>(top + i, fine_width, sums + i);
    for (; i < fine_width; ++i) sum_down<1>(top + i, fine_width, sums + i);
    float* out = pixels.data() + static_cast<std::ptrdiff_t>(v) * width;
    for (int u = 0; u < width; ++u) {
      const float* cells = sums + u * factor_ + start;
      float sum = 0;
      for (int k = 0; k < count; ++k) sum += taps_[static_cast<std::size_t>(k)] * cells[k];
      out[u] = sum;
    }
  }
}

}  // namespace roundel
