#pragma once

#include <array>

#include "core/luma_view.hpp"
#include "core/marker.hpp"
#include "core/segment.hpp"

namespace roundel {

// How wide the outer edges of markers are in a picture, by the direction across them: defocus
// widens all, motion those across its direction.
class EdgeWidths {
 public:
  void clear() { *this = {}; }
  void add(const LumaView& frame, const Ellipse& ellipse, const Levels& levels);

  // Mean width from dark to bright in the most blurred direction, pixels; a sharp picture has 1 to
  // 2.5. Infinite before anything was seen.
  double worst() const;

 private:
  static constexpr int kDirections = 8;
  std::array<double, kDirections> sums_{};
  std::array<int, kDirections> counts_{};
};

}  // namespace roundel
