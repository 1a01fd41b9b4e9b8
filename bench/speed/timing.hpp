#pragma once

#include <string>
#include <vector>

#include "bench/common/distribution.hpp"

namespace roundel::bench {

// How long one system took in one situation.
struct Timing {
  std::string scene;  // "floor" (clutter, noise 3, blur 0.7), "clean", ...
  std::string system;
  std::string frames;  // "following", "first" (nothing known), or what happens in them
  int width = 0, markers = 0;
  Distribution us;        // a frame
  int count = 0;          // frames
  double seen = 0;        // share of the markers in the pictures that it reported
  bool as_wanted = true;  // what `note` tells about: found again soon, no track lost, all sent
  std::string note;
};

using Timings = std::vector<Timing>;

}  // namespace roundel::bench
