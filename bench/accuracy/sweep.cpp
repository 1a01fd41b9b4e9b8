#include "bench/accuracy/sweep.hpp"

#include <functional>
#include <numbers>
#include <utility>

#include "bench/common/placement.hpp"
#include "simulator/random.hpp"

namespace roundel::bench {

namespace {

constexpr double kRadians = std::numbers::pi / 180;
constexpr double kFocal = 921;

struct Setting {
  double distance_m = 2, diameter_m = 0.084;
  double min_incidence_deg = 0, max_incidence_deg = 45;
  Imaging imaging = {.black = 35, .white = 215, .floor = 120, .blur_px = 0.7, .noise_sigma = 3};
};

Experiment experiment_of(const Setting& setting, int poses, std::uint64_t seed) {
  Experiment experiment;
  experiment.camera.width = 640;
  experiment.camera.height = 480;
  experiment.camera.fx = experiment.camera.fy = kFocal;
  experiment.camera.cx = 319.5;
  experiment.camera.cy = 239.5;
  experiment.imaging = setting.imaging;
  experiment.diameter_m = setting.diameter_m;
  experiment.markers = 30;
  experiment.peer_stride = 4;

  Random random(derived_seed(50, seed));
  const double plate = experiment.diameter_m * experiment.plate_ratio;
  while (std::ssize(experiment.views) < poses) {
    PlacedMarker marker;
    marker.number = static_cast<int>(random.below(30));
    const double x = random.uniform(-0.3, 0.3), y = random.uniform(-0.2, 0.2);
    marker.pose.position = setting.distance_m * Eigen::Vector3d(x, y, 1);
    const double tilt =
        random.uniform(setting.min_incidence_deg, setting.max_incidence_deg) * kRadians;
    const double axis = random.uniform(0, 2 * std::numbers::pi);
    const double turn = random.uniform(0, 2 * std::numbers::pi);
    // Tilted against the line of sight, not against the optical axis.
    marker.pose.orientation = with_positive_w(
        Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), marker.pose.position) *
        tilted(tilt, axis, turn));
    const std::uint64_t noise_seed = random.bits();
    if (!plate_in_picture(experiment.camera, marker.pose, plate)) continue;
    experiment.views.push_back({noise_seed, {marker}});
  }
  return experiment;
}

}  // namespace

std::vector<SweepPoint> sweeps(int poses) {
  std::vector<SweepPoint> points;
  const auto vary = [&](const std::string& name, const std::vector<double>& values,
                        const std::function<void(Setting&, double)>& set) {
    for (const double value : values) {
      Setting setting;
      set(setting, value);
      SweepPoint point{name, value, experiment_of(setting, poses, points.size())};
      point.experiment.name = "sweep-" + name;
      points.push_back(std::move(point));
    }
  };
  vary("tilt", {0, 5, 10, 20, 30, 40, 50, 60, 65, 70, 75, 80, 85}, [](Setting& s, double value) {
    s.distance_m = 1;
    s.min_incidence_deg = s.max_incidence_deg = value;
  });
  vary("distance", {0.5, 0.75, 1, 1.5, 2, 2.5, 3, 3.5, 4, 5, 6},
       [](Setting& s, double value) { s.distance_m = value; });
  vary("noise", {0, 1, 2, 3, 5, 7, 10, 15, 20},
       [](Setting& s, double value) { s.imaging.noise_sigma = value; });
  vary("blur", {0, 0.3, 0.5, 0.7, 1, 1.5, 2, 3},
       [](Setting& s, double value) { s.imaging.blur_px = value; });
  vary("gamma", {1, 1.2, 1.4, 1.6, 1.8, 2, 2.2, 2.4},
       [](Setting& s, double value) { s.imaging.gamma = value; });
  vary("size", {14, 17, 20, 25, 30, 40, 60, 90, 130, 200}, [](Setting& s, double value) {
    s.distance_m = 1;
    s.diameter_m = value / kFocal;
  });
  return points;
}

}  // namespace roundel::bench
