#include "bench/common/arena.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "simulator/arena_camera.hpp"
#include "simulator/clutter.hpp"
#include "simulator/random.hpp"
#include "simulator/swarm.hpp"
#include "simulator/visibility.hpp"

namespace roundel::bench {

namespace {

constexpr double kTilt = 2 * std::numbers::pi / 180;  // of the camera: level to 2 degrees
constexpr double kFrameRate = 30;
constexpr int kStepsAFrame = 7;
constexpr int kLeadIn = 10;    // frames in which a tracker may find the markers
constexpr double kMargin = 4;  // pixels between a judged marker and whatever could cover it
constexpr std::uint64_t kSeed = 30;
enum Stream : std::uint64_t { kMotion, kHeights, kClutter, kNoise };

ArenaOptions arena_options(const Experiment& experiment, const ArenaSetting& setting) {
  ArenaOptions options;
  options.image_width = setting.width;
  options.image_height = setting.height;
  options.length_m = setting.length_m;
  options.width_m = setting.width_m;
  options.imaging.noise_sigma = setting.noise_sigma;
  options.imaging.blur_px = setting.blur_px;
  options.imaging.srgb = setting.srgb;
  options.imaging.exposure_s = setting.exposure;
  options.robots = setting.robots;
  options.bits = setting.bits;
  options.corners = false;
  options.diameter_m = experiment.diameter_m;
  options.plate_ratio = experiment.plate_ratio;
  options.camera_tilt = kTilt;
  options.min_height_m = 0.03;
  options.max_height_m = 0.07;
  return options;
}

// Markers above others may cover them; those are not judged. Square plates are assumed, so that
// the same markers are judged for every system.
void judge_what_is_in_sight(const Experiment& experiment, View& view) {
  const double corner = 0.5 * experiment.diameter_m * std::numbers::sqrt2;
  std::vector<ImageOutline> prints, plates;
  for (const PlacedMarker& marker : view.markers) {
    prints.push_back(disc_outline(experiment.camera, marker.pose, corner));
    plates.push_back(disc_outline(experiment.camera, marker.pose, corner * experiment.plate_ratio));
  }
  for (std::size_t i = 0; i < view.markers.size(); ++i) {
    bool& judged = view.markers[i].judged;
    judged = inside_image(prints[i], experiment.camera.width, experiment.camera.height, kMargin);
    for (std::size_t above = i + 1; above < plates.size() && judged; ++above) {
      judged = !closer_than(prints[i], plates[above], kMargin);
    }
  }
}

}  // namespace

Experiment arena(std::string name, std::string title, const ArenaSetting& setting) {
  Experiment experiment;
  experiment.name = std::move(name);
  experiment.title = std::move(title);
  experiment.markers = setting.robots;
  experiment.diameter_m = setting.diameter_m;
  experiment.bits = setting.bits;
  experiment.response_known = setting.response_known;
  experiment.continuous = true;
  experiment.peer_stride = setting.peer_stride;

  const ArenaOptions options = arena_options(experiment, setting);
  const Pose arena_in_camera = arena_in_ceiling_camera(options);
  experiment.camera = arena_camera(options, arena_in_camera);
  experiment.imaging = options.imaging;
  if (setting.clutter) {
    experiment.clutter = arena_clutter(derived_seed(kSeed, kClutter), options.length_m,
                                       options.width_m, arena_in_camera);
  }

  const auto robots = static_cast<std::size_t>(setting.robots);
  Swarm swarm({.robots = setting.robots,
               .length_m = options.length_m,
               .width_m = options.width_m,
               .radius_m = 0.5 * options.diameter_m * options.plate_ratio * std::numbers::sqrt2,
               .obstacles = {},
               .seed = derived_seed(kSeed + robots, kMotion)});
  Random random(derived_seed(kSeed + robots, kHeights));
  std::vector<double> heights(robots);
  for (double& height : heights) {
    height = random.uniform(options.min_height_m, options.max_height_m);
  }
  std::vector<std::size_t> order(robots);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return heights[a] < heights[b]; });

  for (int frame = 0; frame < kLeadIn + setting.frames; ++frame) {
    View view;
    view.noise_seed = derived_seed(derived_seed(kSeed, kNoise), static_cast<std::uint64_t>(frame));
    for (const std::size_t i : order) {
      const Robot& robot = swarm.robots()[i];
      const Eigen::Vector3d forward(robot.heading.x(), robot.heading.y(), 0);
      const double heading = std::atan2(forward.y(), forward.x());
      PlacedMarker marker;
      marker.number = static_cast<int>(i);
      marker.pose.position =
          arena_in_camera.to_camera({robot.position.x(), robot.position.y(), heights[i]});
      marker.pose.orientation =
          with_positive_w(arena_in_camera.orientation *
                          Eigen::Quaterniond(Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ())));
      marker.velocity =
          arena_in_camera.orientation * forward * (setting.speed > 0 ? setting.speed : robot.speed);
      marker.spin = arena_in_camera.orientation * Eigen::Vector3d(0, 0, robot.turn_rate);
      view.markers.push_back(marker);
    }
    judge_what_is_in_sight(experiment, view);
    if (frame < kLeadIn) {
      for (PlacedMarker& marker : view.markers) marker.judged = false;
    }
    experiment.views.push_back(std::move(view));
    for (int k = 0; k < kStepsAFrame; ++k) swarm.step(1 / (kFrameRate * kStepsAFrame));
  }
  return experiment;
}

}  // namespace roundel::bench
