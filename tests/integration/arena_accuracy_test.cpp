// A simulated arena, calibrated from its corner markers and held against the truth: 3 m x 2 m from
// 3 m above, webcam lens, noise 3, robots with markers 0 to 15 cm above the floor.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "calibration/arena_calibrator.hpp"
#include "calibration/arena_map.hpp"
#include "core/tracker.hpp"
#include "simulator/arena.hpp"

namespace roundel {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || !defined(__OPTIMIZE__)
constexpr int kFrames = 40;
#else
constexpr int kFrames = 300;
#endif

struct Errors {
  std::vector<double> position, heading;                // metres, radians
  std::vector<double> position_sigmas, heading_sigmas;  // errors over the stated deviations

  static double mean(const std::vector<double>& values) {
    double sum = 0;
    for (const double value : values) sum += value;
    return sum / static_cast<double>(values.size());
  }
  static double worst(const std::vector<double>& values) {
    return *std::max_element(values.begin(), values.end());
  }
  static double within_one(const std::vector<double>& values) {
    return static_cast<double>(std::count_if(values.begin(), values.end(),
                                             [](double v) { return std::abs(v) < 1; })) /
           static_cast<double>(values.size());
  }
};

ArenaOptions arena_of(double tilt, MarkerKind corners) {
  ArenaOptions options;
  options.corner_kind = corners;
  options.camera_tilt = tilt;
  options.robots = 12;
  options.min_height_m = 0;
  options.max_height_m = 0.15;
  options.imaging.noise_sigma = 3;
  return options;
}

ArenaRequest request_of(const ArenaOptions& options) {
  ArenaRequest request;
  request.width_m = options.length_m;
  request.height_m = options.width_m;
  return request;
}

struct Run {
  ArenaCalibration calibration;
  Errors floor, space;
};

Run run(const ArenaOptions& options, const ArenaRequest& request) {
  Arena arena(options);
  DetectorParameters parameters;
  parameters.bits = options.bits;
  parameters.diameter_m = options.diameter_m;
  Tracker tracker(parameters, arena.camera());
  ArenaCalibrator calibrator(request, {"simulator", "", arena.camera()}, options.diameter_m);
  GreyImage image;
  std::int64_t frame = 0;
  for (; frame < 200 && (frame % 10 != 0 || !calibrator.progress().done); ++frame) {
    arena.render(frame, image);
    calibrator.add(tracker.track(image.view()));
  }
  Run result;
  result.calibration = calibrator.result();

  MarkerMounts mounts;  // every robot's marker has a height of its own
  for (const MarkerTruth& truth : arena.truth(0).markers) {
    if (truth.id < 0) continue;
    MarkerMount mount;
    mount.height_m = truth.z;
    mounts.by_id.push_back({truth.id, mount});
  }
  const ArenaMap floor(result.calibration, ArenaMode::k2D, mounts);
  const ArenaMap space(result.calibration, ArenaMode::k3D, {});
  const auto add = [](Errors& errors, const ArenaPose& found, const MarkerTruth& truth) {
    REQUIRE(found.valid);
    const Eigen::Vector3d off = found.position - Eigen::Vector3d(truth.x, truth.y, truth.z);
    errors.position.push_back(off.norm());
    errors.position_sigmas.push_back(off.x() / found.sigma_position.x());
    errors.position_sigmas.push_back(off.y() / found.sigma_position.y());
    const double turn = std::remainder(found.heading - truth.heading, 2 * std::numbers::pi);
    errors.heading.push_back(std::abs(turn));
    errors.heading_sigmas.push_back(turn / found.sigma_heading);
  };
  for (const std::int64_t end = frame + kFrames; frame < end; ++frame) {
    arena.render(frame, image);
    const FrameTruth& truth = arena.truth(frame);
    for (const Marker& marker : tracker.track(image.view())) {
      if (marker.id < 0) continue;
      const auto same = std::find_if(truth.markers.begin(), truth.markers.end(),
                                     [&](const MarkerTruth& t) { return t.id == marker.id; });
      REQUIRE(same != truth.markers.end());
      if (!same->visible) continue;
      add(result.floor, floor.locate(marker), *same);
      add(result.space, space.locate(marker), *same);
    }
  }
  return result;
}

void report(const char* what, const Errors& errors) {
  MESSAGE(what << ": position mean " << 1000 * Errors::mean(errors.position) << " mm, worst "
               << 1000 * Errors::worst(errors.position) << " mm; heading mean "
               << Errors::mean(errors.heading) << " rad, worst " << Errors::worst(errors.heading)
               << " rad; within one sigma: position "
               << 100 * Errors::within_one(errors.position_sigmas) << " %, heading "
               << 100 * Errors::within_one(errors.heading_sigmas) << " %; "
               << errors.position.size() << " poses");
}

}  // namespace

TEST_CASE("on the floor of a calibrated arena a robot is found to the millimetre") {
  constexpr double kTwentyDegrees = 20 * std::numbers::pi / 180;
  double tilt = 0;
  MarkerKind corners = MarkerKind::WhyCon;
  SUBCASE("seen from straight above, plain corner markers") {}
  SUBCASE("seen from straight above, corner markers with codes") {
    corners = MarkerKind::WhyCode;
  }
  SUBCASE("seen by a camera tilted by 20 degrees") {
    tilt = kTwentyDegrees;
  }
  SUBCASE("seen by a tilted camera, corner markers with codes") {
    tilt = kTwentyDegrees;
    corners = MarkerKind::WhyCode;
  }
  const ArenaOptions options = arena_of(tilt, corners);
  ArenaRequest request = request_of(options);
  if (corners == MarkerKind::WhyCode) request.ids = {13, 14, 15, 16};
  const Run result = run(options, request);
  MESSAGE("certain to " << 1000 * result.calibration.certainty_m << " mm after "
                        << result.calibration.frames << " frames; residual of the corners "
                        << 1000 * result.calibration.references[0].residual.norm() << " mm; size "
                        << result.calibration.size_by_markers);
  report("2D", result.floor);
  report("3D", result.space);
  CHECK(Errors::mean(result.floor.position) <= 0.001);
  CHECK(Errors::worst(result.floor.position) <= 0.004);
  CHECK(Errors::mean(result.floor.heading) <= 0.005);
}

}  // namespace roundel
