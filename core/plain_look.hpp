#pragma once

#include "core/luma_view.hpp"
#include "core/plane_projection.hpp"
#include "core/segment.hpp"

namespace roundel {

// What lies beside the edges of something that may be a marker: rings in icons, letters and lids
// have no paper around that is white all over, or more in the dark than a print has.
struct Surroundings {
  double noise =
      0;  // of the margin's pixels, or of the dark ring's where one is expected; grey levels
  double margin_off = 0;  // share of the margin that is not white
  double ring_off = 0;    // share of the dark ring that is not black; 0 where none is expected
};

// `inner_ratio`: where the dark ring of a plain marker begins; 0: there are teeth instead.
Surroundings look_around(const LumaView& frame, const PlaneProjection& projection,
                         double inner_ratio, double blur_px, const Levels& levels);

}  // namespace roundel
