#pragma once

#include <vector>

#include "simulator/figure.hpp"
#include "simulator/scene.hpp"

namespace roundel {

// Uneven light over the image: a linear gradient and the hard edge of a shadow, as factors.
class Light {
 public:
  // Throws std::invalid_argument for values out of range.
  Light(const Imaging& imaging, int width, int height);

  // Multiplies cells of a fine grid by the light that falls there.
  void apply(std::vector<float>& cells, const FineFrame& frame, int width, int height) const;

 private:
  bool even_ = true;
  double slope_u_ = 0, slope_v_ = 0;    // of the gradient, per pixel
  double middle_u_ = 0, middle_v_ = 0;  // where it is 1
  double shadow_u_ = 0, shadow_v_ = 0;  // unit vector into the shadow
  double shadow_start_ = 0;             // the line's place along it, pixels
  double shadow_factor_ = 1;
};

}  // namespace roundel
