#pragma once

#include <optional>
#include <span>
#include <string>

#include "calibration/arena_calibration.hpp"
#include "calibration/arena_collector.hpp"
#include "calibration/arena_corners.hpp"

namespace roundel {

// Throws std::invalid_argument, with a sentence for the user, for a request that makes no sense.
void check(const ArenaRequest& request);

// Calibrates an arena from the markers of consecutive frames. Give it frames until it is done, or
// until the time limit, then ask for the result.
class ArenaCalibrator {
 public:
  // `diameter_m` is what the markers' poses were computed with. Throws like check().
  ArenaCalibrator(const ArenaRequest& request, const ArenaCamera& camera, double diameter_m);

  const ArenaRequest& request() const { return request_; }
  void add(std::span<const Marker> markers) { collector_.add(markers); }

  // How far it is. `text` says in a clause what is missing.
  struct Progress {
    int frames = 0;
    std::size_t markers = 0;            // fixed ones that are used
    std::optional<double> certainty_m;  // reached by now
    bool done = false;                  // as certain as was asked for
    std::string text;
  };
  Progress progress() const;

  // The calibration from the frames so far, without date and version. Throws ArenaRefusal.
  ArenaCalibration result() const;

 private:
  std::vector<SeenReference> references() const;
  void add_anchors(const std::vector<StillMarker>& still,
                   std::vector<SeenReference>& references) const;
  void refuse_misplaced(const std::vector<ArenaReference>& references) const;
  double size_by_markers(const Pose& arena_in_camera,
                         std::span<const SeenReference> references) const;

  ArenaRequest request_;
  ArenaCamera camera_;
  double diameter_m_;
  ArenaCollector collector_;
};

}  // namespace roundel
