#pragma once

#include <string>
#include <vector>

#include "bench/accuracy/experiment.hpp"

namespace roundel::bench {

// One marker of 20 cm in a clean Full-HD picture, 3 to 5 m away, tilted against the optical axis.
Experiment artificial(std::string name, double min_tilt_deg, double max_tilt_deg, int poses);

struct ArenaSetting {
  int robots = 7;
  int bits = 8;
  int frames = 430;     // judged ones
  bool srgb = false;    // the camera encodes its pictures as sRGB
  double exposure = 0;  // seconds
  double speed = 0;     // every robot's, m/s; 0: as they happen to drive
};

// Robots with markers of 8.4 cm on a cluttered floor, seen from 3 m above through a webcam's lens.
Experiment arena(std::string name, std::string title, const ArenaSetting& setting);

// One marker of 8.4 cm turned on the spot through pan -90 ... 90 and tilt -40 ... 30 degrees in
// steps of 5: 555 poses, of which those are judged that show a marker of a readable size. `stride`
// takes every stride-th pan row.
Experiment manipulator(std::string name, double distance_m, double noise_sigma, int stride);

// All of the paper's experiments in our rendition (METHOD.md sections 8 and 9), with one in
// `thinning` of the poses.
std::vector<Experiment> paper_experiments(int thinning);

}  // namespace roundel::bench
