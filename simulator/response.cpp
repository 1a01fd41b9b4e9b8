#include "simulator/response.hpp"

#include <algorithm>
#include <cmath>

namespace roundel {

namespace {

constexpr int kTableSize = 4096;
constexpr float kWhite = 255.0F;

}  // namespace

Response::Response(double gamma, bool srgb)
    : gamma_(gamma), srgb_(srgb), linear_(!srgb && gamma == 1) {
  if (linear_) return;
  table_.resize(kTableSize + 2);
  for (int i = 0; i < kTableSize + 2; ++i) {
    const double root = static_cast<double>(i) / kTableSize;
    const double grey = std::min(255.0, grey_of_light(255.0 * root * root));
    table_[static_cast<std::size_t>(i)] = static_cast<float>(grey);
  }
}

double Response::light_of_grey(double grey) const {
  if (linear_) return grey;
  const double g = grey / 255.0;
  if (!srgb_) return 255.0 * std::pow(g, gamma_);
  return 255.0 * (g <= 0.04045 ? g / 12.92 : std::pow((g + 0.055) / 1.055, 2.4));
}

double Response::grey_of_light(double light) const {
  if (linear_) return light;
  const double l = light / 255.0;
  if (!srgb_) return 255.0 * std::pow(l, 1 / gamma_);
  return 255.0 * (l <= 0.0031308 ? 12.92 * l : 1.055 * std::pow(l, 1 / 2.4) - 0.055);
}

void Response::encode(const float* light, std::int16_t* grey, int count) const {
  constexpr float kScale = kFixedOne;
  if (linear_) {
    for (int i = 0; i < count; ++i) {
      const float clipped = std::min(std::max(light[i], 0.0F), kWhite);
      const float rounded = clipped * kScale + 0.5F;
      grey[i] = static_cast<std::int16_t>(rounded);
    }
    return;
  }
  for (int i = 0; i < count; ++i) {
    const float clipped = std::min(std::max(light[i], 0.0F), kWhite);
    const float place = std::sqrt(clipped / kWhite) * kTableSize;
    const int cell = static_cast<int>(place);
    const float low = table_[static_cast<std::size_t>(cell)];
    const float high = table_[static_cast<std::size_t>(cell) + 1];
    const float value = low + (high - low) * (place - static_cast<float>(cell));
    const float rounded = value * kScale + 0.5F;
    grey[i] = static_cast<std::int16_t>(rounded);
  }
}

}  // namespace roundel
