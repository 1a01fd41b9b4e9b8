#include "simulator/optics.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace roundel {

namespace {

constexpr double kMaxBlur = 10;       // pixels
constexpr double kCutoff = 4;         // standard deviations
constexpr double kCellsPerSigma = 2;  // a sampled Gaussian of this width is exact to 1e-6

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
  factor_ = std::clamp(static_cast<int>(std::ceil(kCellsPerSigma / blur_px)), 1, 4);
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
    for (int i = 0; i < fine_width; ++i) sums[i] = taps_[0] * top[i];
    for (int k = 1; k < count; ++k) {
      const float tap = taps_[static_cast<std::size_t>(k)];
      const float* row = top + static_cast<std::ptrdiff_t>(k) * fine_width;
      for (int i = 0; i < fine_width; ++i) sums[i] += tap * row[i];
    }
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
