#pragma once

#include <string>
#include <vector>

#include "bench/common/experiment.hpp"

namespace roundel::bench {

// One experiment at one value of what is varied.
struct SweepPoint {
  std::string sweep;  // name of what is varied
  double value = 0;
  Experiment experiment;
};

// A marker of 8.4 cm 2 m in front of a camera of f = 921 px (640 x 480; sigma 3, blur 0.7, black
// 35, white 215), seen 0 to 45 degrees off its normal; of that, one thing at a time is varied:
// tilt (degrees off the normal, at 1 m), distance (metres), noise (grey levels), blur (pixels),
// gamma, size (diameter in pixels, at 1 m).
std::vector<SweepPoint> sweeps(int poses);

}  // namespace roundel::bench
