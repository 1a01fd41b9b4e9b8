#pragma once

#include <string>
#include <vector>

#include "bench/common/experiment.hpp"

namespace roundel::bench {

// One marker of 20 cm in a clean Full-HD picture, 3 to 5 m away, tilted against the optical axis.
Experiment artificial(std::string name, double min_tilt_deg, double max_tilt_deg, int poses);

// One marker of 8.4 cm turned on the spot through pan -90 ... 90 and tilt -40 ... 30 degrees in
// steps of 5: 555 poses, of which those are judged that show a marker of a readable size. `stride`
// takes every stride-th pan row.
Experiment manipulator(std::string name, double distance_m, double noise_sigma, int stride);

// All of the paper's experiments in our rendition (METHOD.md sections 8 and 9), with one in
// `thinning` of the poses.
std::vector<Experiment> paper_experiments(int thinning);

}  // namespace roundel::bench
