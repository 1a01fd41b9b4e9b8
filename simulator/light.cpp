#include "simulator/light.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace roundel {

Light::Light(const Imaging& imaging, int width, int height)
    : slope_u_(imaging.gradient * std::cos(imaging.gradient_angle) / width),
      slope_v_(imaging.gradient * std::sin(imaging.gradient_angle) / width),
      middle_u_(0.5 * (width - 1)),
      middle_v_(0.5 * (height - 1)),
      shadow_u_(std::cos(imaging.shadow_angle)),
      shadow_v_(std::sin(imaging.shadow_angle)),
      shadow_start_(imaging.shadow_u * shadow_u_ + imaging.shadow_v * shadow_v_),
      shadow_factor_(imaging.shadow_factor) {
  if (!(imaging.gradient >= -1 && imaging.gradient <= 1)) {
    throw std::invalid_argument("gradient must lie between -1 and 1");
  }
  if (!(imaging.shadow_factor >= 0 && imaging.shadow_factor <= 1)) {
    throw std::invalid_argument("shadow_factor must lie between 0 and 1");
  }
  even_ = imaging.gradient == 0 && imaging.shadow_factor == 1;
}

void Light::apply(std::vector<float>& cells, const FineFrame& frame, int width, int height) const {
  if (even_) return;
  const double cell = 1.0 / frame.factor;
  for (int j = 0; j < height; ++j) {
    const double v = frame.top - 0.5 + (j + 0.5) * cell;
    float* row = cells.data() + static_cast<std::ptrdiff_t>(j) * width;
    for (int i = 0; i < width; ++i) {
      const double u = frame.left - 0.5 + (i + 0.5) * cell;
      const double even = 1 + slope_u_ * (u - middle_u_) + slope_v_ * (v - middle_v_);
      // Share of the cell in the shadow, as if the edge crossed it squarely.
      const double depth = (shadow_u_ * u + shadow_v_ * v - shadow_start_) * frame.factor;
      const double shade = std::clamp(depth + 0.5, 0.0, 1.0);
      row[i] *= static_cast<float>(even * (1 + (shadow_factor_ - 1) * shade));
    }
  }
}

}  // namespace roundel
