#pragma once

#include "bench/common/experiment.hpp"
#include "bench/common/placement.hpp"

namespace roundel::bench {

// One marker of 30 cm, number 3 of 30, 2 m in front of a small camera and turned half a degree.
inline Experiment one_marker(double noise_sigma = 0) {
  Experiment experiment;
  experiment.camera.width = 320;
  experiment.camera.height = 240;
  experiment.camera.fx = experiment.camera.fy = 400;
  experiment.camera.cx = 159.5;
  experiment.camera.cy = 119.5;
  experiment.imaging = {
      .black = 30, .white = 200, .floor = 110, .blur_px = 0.7, .noise_sigma = noise_sigma};
  experiment.diameter_m = 0.3;
  experiment.markers = 30;
  PlacedMarker marker;
  marker.number = 3;
  marker.pose.position = {0.1, -0.05, 2};
  marker.pose.orientation = tilted(0.4, 1, 0.3);
  experiment.views.push_back({77, {marker}});
  return experiment;
}

}  // namespace roundel::bench
