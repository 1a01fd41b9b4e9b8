#include <cmath>
#include <numbers>
#include <utility>

#include "bench/accuracy/paper_experiments.hpp"
#include "bench/common/placement.hpp"
#include "simulator/random.hpp"

namespace roundel::bench {

namespace {

constexpr double kRadians = std::numbers::pi / 180;
constexpr int kPanSteps = 37, kTiltSteps = 15;  // of 5 degrees: 555 poses
constexpr int kLeadIn = 10;                     // views in which a tracker may find the marker
constexpr int kViewsAStep = 5;                  // the pan goes on at 1 degree a view
constexpr double kTurn = 0.3;                   // about the normal, radians
constexpr double kBlur = 0.5;                   // pixels

// Judged are poses that show a marker as large as Roundel says to read (14 px across its shorter
// side) and not steeper than a printed marker is seen in practice.
constexpr double kMinShortSide = 14, kMaxIncidence = 75 * kRadians;

CameraModel manipulator_camera() {
  CameraModel camera;
  camera.width = 1280;
  camera.height = 720;
  camera.fx = camera.fy = 921;
  camera.cx = 0.5 * (camera.width - 1);
  camera.cy = 0.5 * (camera.height - 1);
  return camera;
}

Pose pose_at(double distance_m, int row, double pan, double tilt, double place) {
  // Rows stand apart, so that each is a track of its own; within a row the marker drifts over some
  // pixels, because errors depend on where the pixel grid lies.
  const double side = row % 2 == 0 ? -0.15 : 0.15;
  Pose pose;
  pose.position = {distance_m * (side + 0.02 * std::sin(2.1 * place + row)),
                   distance_m * 0.02 * std::sin(1.3 * place + 0.7 * row), distance_m};
  const Eigen::Quaterniond turned(Eigen::AngleAxisd(pan, Eigen::Vector3d::UnitY()) *
                                  Eigen::AngleAxisd(tilt, Eigen::Vector3d::UnitX()));
  pose.orientation =
      with_positive_w(turned * facing_camera() *
                      Eigen::Quaterniond(Eigen::AngleAxisd(kTurn, Eigen::Vector3d::UnitZ())));
  return pose;
}

}  // namespace

Experiment manipulator(std::string name, double distance_m, double noise_sigma, int stride) {
  Experiment experiment;
  experiment.name = std::move(name);
  experiment.title = "manipulator " + std::to_string(static_cast<int>(distance_m)) + " m, sigma " +
                     std::to_string(static_cast<int>(noise_sigma));
  experiment.camera = manipulator_camera();
  experiment.imaging = {
      .black = 35, .white = 210, .floor = 120, .blur_px = kBlur, .noise_sigma = noise_sigma};
  experiment.markers = kTiltSteps;
  experiment.continuous = true;
  experiment.peer_stride = 4;

  std::uint64_t seed = 0;
  for (int row = 0; row < kTiltSteps; row += stride) {
    const double tilt = (-40 + 5 * row) * kRadians;
    int lead_in = kLeadIn;
    for (int step = 0; step < (kPanSteps - 1) * kViewsAStep + 1; ++step) {
      const double pan = (-90 + 5.0 * step / kViewsAStep) * kRadians;
      PlacedMarker marker;
      marker.number = row;
      marker.pose = pose_at(distance_m, row, pan, tilt, 0.1 * step);
      if (incidence(marker.pose) > kMaxIncidence) continue;
      if (short_side_px(experiment.camera, marker.pose, experiment.diameter_m) < kMinShortSide) {
        continue;
      }
      marker.judged = false;
      for (; lead_in > 0; --lead_in) experiment.views.push_back({++seed, {marker}});
      marker.judged = step % kViewsAStep == 0;
      experiment.views.push_back({++seed, {marker}});
    }
  }
  for (View& view : experiment.views) view.noise_seed = derived_seed(40, view.noise_seed);
  return experiment;
}

}  // namespace roundel::bench
