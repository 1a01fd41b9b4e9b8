#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/camera_model.hpp"
#include "core/marker.hpp"

namespace roundel {

// A marker that stood still, averaged over the frames in which it was seen.
struct StillMarker {
  int id = -1;                                           // -1: no code
  Eigen::Vector2d ray = Eigen::Vector2d::Zero();         // of its centre, normalised
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  // of `ray`
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();       // image of its centre
  Eigen::Vector3d position = Eigen::Vector3d::Zero();    // camera frame, by its own diameter
  double share = 0;                                      // of the frames it was seen in
};

// Collects what frames show and averages what stands still. Frames in which a marker was half
// covered or shaken are outliers and don't count; what moves does not count at all.
class ArenaCollector {
 public:
  explicit ArenaCollector(const CameraModel& camera) : camera_(camera) {}

  void add(std::span<const Marker> markers);

  int frames() const { return frames_; }

  // Markers that stood still in at least the given share of the frames.
  std::vector<StillMarker> still_markers(double least_share) const;

  // What is known of the markers with an id.
  struct Sighting {
    double share = 0;    // of the frames in which one was seen
    bool moves = false;  // it was seen, but not in one place
    bool twice = false;  // two were seen at a time
  };
  Sighting sighting(int id) const;

 private:
  struct Sample {
    Eigen::Vector2d ray;
    double distance;  // along the optical axis, metres
  };
  struct Place {
    int id = -1;
    Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  // of the last sample
    int last_frame = 0;
    bool twice = false;  // two markers at a time claimed to be this one: neither is used
    std::vector<Sample> samples;
  };
  Place& place_of(const Marker& marker);
  bool average(const Place& place, StillMarker& still) const;

  CameraModel camera_;
  int frames_ = 0;
  std::vector<Place> places_;
};

}  // namespace roundel
