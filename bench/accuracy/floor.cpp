#include "bench/accuracy/floor.hpp"

#include <fmt/ostream.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "bench/common/distribution.hpp"
#include "calibration/arena_calibrator.hpp"
#include "calibration/arena_map.hpp"
#include "core/tracker.hpp"
#include "simulator/arena.hpp"

namespace roundel::bench {

namespace {

constexpr int kMaxCalibration = 200;  // frames
constexpr double kMaxPosition = 0.3, kMaxHeading = 0.003;

ArenaOptions arena_options() {
  ArenaOptions options;
  options.robots = 26;  // and four corners
  options.diameter_m = 0.084;
  options.min_height_m = 0.03;
  options.max_height_m = 0.07;
  options.imaging.noise_sigma = 3;
  options.imaging.blur_px = 0.7;
  return options;
}

// Every robot's marker stands at a height of its own, which is known.
MarkerMounts mounts_of(const FrameTruth& truth) {
  MarkerMounts mounts;
  for (const MarkerTruth& marker : truth.markers) {
    if (marker.id < 0) continue;
    MarkerMount mount;
    mount.height_m = marker.z;
    mounts.by_id.push_back({marker.id, mount});
  }
  return mounts;
}

}  // namespace

void write_floor(std::ostream& markdown, int frames) {
  const ArenaOptions options = arena_options();
  Arena arena(options);
  DetectorParameters parameters;
  parameters.bits = options.bits;
  parameters.diameter_m = options.diameter_m;
  Tracker tracker(parameters, arena.camera());
  ArenaRequest request;
  request.width_m = options.length_m;
  request.height_m = options.width_m;
  ArenaCalibrator calibrator(request, {"simulator", "", arena.camera()}, options.diameter_m);
  GreyImage picture;
  std::int64_t frame = 0;
  for (; frame < kMaxCalibration && (frame % 10 != 0 || !calibrator.progress().done); ++frame) {
    arena.render(frame, picture);
    calibrator.add(tracker.track(picture.view()));
  }
  const ArenaMap map(calibrator.result(), ArenaMode::k2D, mounts_of(arena.truth(0)));

  std::vector<double> position, heading;  // mm in the plane; radians
  int visible = 0;
  for (const std::int64_t end = frame + frames; frame < end; ++frame) {
    arena.render(frame, picture);
    const auto markers = tracker.track(picture.view());
    for (const MarkerTruth& truth : arena.truth(frame).markers) {
      if (truth.id < 0 || !truth.visible) continue;
      ++visible;
      const auto found = std::find_if(markers.begin(), markers.end(),
                                      [&](const Marker& m) { return m.id == truth.id; });
      if (found == markers.end()) continue;
      const ArenaPose pose = map.locate(*found);
      if (!pose.valid) continue;
      position.push_back(1000 *
                         std::hypot(pose.position.x() - truth.x, pose.position.y() - truth.y));
      heading.push_back(
          std::abs(std::remainder(pose.heading - truth.heading, 2 * std::numbers::pi)));
    }
  }
  const double found = visible > 0 ? 100.0 * static_cast<double>(position.size()) / visible : 0;
  const Distribution p = distribution_of(position), h = distribution_of(heading);
  const bool met = found == 100 && p.mean <= kMaxPosition && h.mean <= kMaxHeading;
  fmt::print(markdown, R"(# The arena in 2D mode

Written by `bench/run-accuracy`; do not edit. {} robots with 8.4 cm markers 3 to 7 cm above the floor of 3 m × 2 m,
seen from 3 m above in Full HD, noise 3, blur 0.7; calibrated from four plain corner markers in {} frames. The
tracker's poses go through the same map as the daemon's.

| | found | mean | median | p99 | worst | target |
|---|--:|--:|--:|--:|--:|---|
| position in the plane, mm | {:.2f} % | {:.4f} | {:.4f} | {:.4f} | {:.4f} | ≤ {} |
| heading, rad | | {:.5f} | {:.5f} | {:.5f} | {:.5f} | ≤ {} |

{} poses: {}.
)",
             options.robots, calibrator.result().frames, found, p.mean, p.median, p.p99, p.worst,
             kMaxPosition, h.mean, h.median, h.p99, h.worst, kMaxHeading, position.size(),
             met ? "met" : "**missed**");
}

}  // namespace roundel::bench
