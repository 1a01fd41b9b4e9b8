#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/camera_model.hpp"
#include "core/pose.hpp"
#include "simulator/scene.hpp"

namespace roundel::bench {

// A marker of whatever system, standing somewhere in front of the camera.
struct PlacedMarker {
  int number = 0;  // which of the experiment's markers, from 0; wears the number-th id of a system
  Pose pose;       // marker in camera, at the middle of the exposure
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  // m/s, camera axes
  Eigen::Vector3d spin = Eigen::Vector3d::Zero();      // rad/s about the camera axes
  bool judged = true;  // counts; otherwise it is there, but nobody is asked for it
};

// One picture. Markers are painted in their order: what comes later covers what came before.
struct View {
  std::uint64_t noise_seed = 0;
  std::vector<PlacedMarker> markers;

  bool judged() const {
    for (const PlacedMarker& marker : markers) {
      if (marker.judged) return true;
    }
    return false;
  }
};

// The same poses, camera, light and noise for every system. Only what is printed on the plates
// differs: a circular marker's outer black diameter is a square tag's outer black side.
struct Experiment {
  std::string name;   // short, for options and files
  std::string title;  // for tables
  CameraModel camera;
  Imaging imaging;
  double diameter_m = 0.084;
  double plate_ratio = 1.35;    // white plate over marker
  int markers = 1;              // PlacedMarker::number < markers
  int bits = 8;                 // of WhyCode markers: enough for as many ids
  bool response_known = false;  // the camera's response curve is told to whoever can use it
  int peer_stride = 1;          // peers are shown one in so many views: where they take long
  bool continuous = false;      // views follow each other as a camera would take them
  std::vector<SceneShape> clutter;
  std::vector<View> views;
};

}  // namespace roundel::bench
