#pragma once

#include <string>

#include "bench/common/experiment.hpp"

namespace roundel::bench {

struct ArenaSetting {
  int robots = 7;
  int bits = 8;
  int frames = 430;  // judged ones
  int width = 1920;  // of the picture, pixels
  int height = 1080;
  double diameter_m = 0.084;
  double length_m = 3;  // of the floor
  double width_m = 2;
  double noise_sigma = 3;  // grey levels
  double blur_px = 0.7;
  bool clutter = true;  // on the floor
  bool srgb = false;    // the camera encodes its pictures as sRGB
  bool response_known = false;
  double exposure = 0.005;  // seconds
  int peer_stride = 1;
  double speed = 0;  // every robot's, m/s; 0: as they happen to drive
};

// Robots with markers on a floor, seen from 3 m above through a webcam's lens at 30 frames a
// second. The first frames are not judged: in them a tracker may find the markers.
Experiment arena(std::string name, std::string title, const ArenaSetting& setting);

}  // namespace roundel::bench
