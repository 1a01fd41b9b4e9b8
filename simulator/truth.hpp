#pragma once

#include <cstdint>
#include <vector>

#include "core/pose.hpp"
#include "simulator/scene.hpp"

namespace roundel {

// What is true of one marker in one frame, at the middle of the exposure.
struct MarkerTruth {
  MarkerKind kind = MarkerKind::WhyCode;
  int id = -1;           // -1 for kinds without a code
  Pose pose;             // marker in camera
  double u = 0, v = 0;   // image of the marker's centre through the lens, pixels
  bool visible = false;  // the black disc lies inside of the image and nothing covers it, both with
                         // a margin of some pixels for blur; it faces the camera
  double x = 0, y = 0, z = 0;  // arena frame, metres
  double heading = 0;          // of the marker's x axis about the arena's z, in (-pi, pi]
};

struct FrameTruth {
  std::int64_t frame = 0;
  double time_s = 0;                 // of the middle of the exposure; frame 0 is at 0
  std::vector<MarkerTruth> markers;  // corner markers first, then robots
};

}  // namespace roundel
