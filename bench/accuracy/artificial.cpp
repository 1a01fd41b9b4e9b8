#include <numbers>
#include <utility>

#include "bench/accuracy/paper_experiments.hpp"
#include "bench/common/placement.hpp"
#include "simulator/random.hpp"

namespace roundel::bench {

namespace {

constexpr double kRadians = std::numbers::pi / 180;
constexpr double kMaxIncidence = 85 * kRadians;

CameraModel artificial_camera() {
  CameraModel camera;
  camera.width = 1920;
  camera.height = 1080;
  camera.fx = camera.fy = 1000;
  camera.cx = 0.5 * (camera.width - 1);
  camera.cy = 0.5 * (camera.height - 1);
  return camera;
}

}  // namespace

Experiment artificial(std::string name, double min_tilt_deg, double max_tilt_deg, int poses) {
  Experiment experiment;
  experiment.name = std::move(name);
  experiment.title = "artificial, tilt " + std::to_string(static_cast<int>(min_tilt_deg)) + "-" +
                     std::to_string(static_cast<int>(max_tilt_deg)) + " deg";
  experiment.camera = artificial_camera();
  experiment.imaging = {.black = 10, .white = 245, .floor = 178};
  experiment.diameter_m = 0.2;
  experiment.peer_stride = 3;
  experiment.markers = 30;  // as many as the smallest of the id sets has

  Random random(derived_seed(20, static_cast<std::uint64_t>(max_tilt_deg)));
  const double plate = experiment.diameter_m * experiment.plate_ratio;
  while (std::ssize(experiment.views) < poses) {
    PlacedMarker marker;
    marker.number = static_cast<int>(random.below(static_cast<std::uint32_t>(experiment.markers)));
    // One call a line: the order of evaluation within an expression is the compiler's.
    marker.pose.position.x() = random.uniform(-1.5, 1.5);
    marker.pose.position.y() = random.uniform(-1.5, 1.5);
    marker.pose.position.z() = random.uniform(3, 5);
    const double tilt = random.uniform(min_tilt_deg, max_tilt_deg) * kRadians;
    const double axis = random.uniform(0, 2 * std::numbers::pi);
    const double turn = random.uniform(0, 2 * std::numbers::pi);
    marker.pose.orientation = tilted(tilt, axis, turn);
    if (incidence(marker.pose) > kMaxIncidence) continue;
    if (!plate_in_picture(experiment.camera, marker.pose, plate)) continue;
    experiment.views.push_back({0, {marker}});
  }
  return experiment;
}

}  // namespace roundel::bench
