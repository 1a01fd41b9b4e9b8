// One marker after another, drawn without noise: what is left is the method's own error.

#include <doctest/doctest.h>

#include <cmath>

#include "core/detector.hpp"
#include "core/tracker.hpp"
#include "simulator/random.hpp"
#include "tests/integration/one_marker.hpp"

namespace roundel {
namespace {

using namespace one_marker;

// The one marker in a picture, with its id.
Marker detected(const SceneMarker& marker, const Imaging& imaging, const ResponseCurve& response,
                std::uint64_t noise_seed = 1) {
  GreyImage image;
  Renderer(camera(), imaging).render(scene_of(marker), noise_seed, image);
  DetectorParameters parameters;
  parameters.diameter_m = marker.diameter_m;
  parameters.response = response;
  Detector detector(parameters, camera());
  const auto found = detector.detect(image.view());
  REQUIRE(found.size() == 1);
  REQUIRE(found[0].id == kId);
  return found[0];
}

struct Errors {
  double distance = 0;  // of the position's error, share of the distance
  double orientation = 0;
};

Errors errors_of(const Imaging& imaging, const ResponseCurve& response, double incidence,
                 const Eigen::Vector3d& velocity) {
  SceneMarker marker = marker_at({0.011, -0.007, 2}, incidence);
  marker.velocity = velocity;
  const Marker found = detected(marker, imaging, response);
  return {(found.pose.position - marker.pose.position).norm() / marker.pose.position.z(),
          orientation_error(found.pose.orientation, marker.pose.orientation)};
}

Imaging usual_imaging() {
  return imaging(0.6, 0);
}

}  // namespace

TEST_CASE("tilt does not bias the distance, though rims are curved and teeth narrow") {
  for (const double incidence : {15.0, 30.0, 45.0, 60.0}) {
    CAPTURE(incidence);
    const Errors errors =
        errors_of(usual_imaging(), ResponseCurve::linear(), incidence * kDegree, {0, 0, 0});
    CHECK(errors.distance < 2e-4);
    CHECK(errors.orientation < 8e-4);
  }
}

TEST_CASE("with its response curve known, a camera with gamma is as good as a linear one") {
  Imaging imaging = usual_imaging();
  imaging.srgb = true;
  const Errors known = errors_of(imaging, ResponseCurve::srgb(), 0.5, {0, 0, 0});
  CHECK(known.distance < 2e-4);
  CHECK(known.orientation < 8e-4);
  // This is what it mends.
  const Errors unknown = errors_of(imaging, ResponseCurve::linear(), 0.5, {0, 0, 0});
  CHECK(unknown.distance > 4e-4);
}

TEST_CASE("a marker that is followed tells its camera's gamma within some frames") {
  Imaging imaging = usual_imaging();
  imaging.srgb = true;
  imaging.noise_sigma = 1;
  const SceneMarker marker = marker_at({0.011, -0.007, 2}, 0.5);
  Renderer renderer(camera(), imaging);
  DetectorParameters parameters;
  parameters.diameter_m = marker.diameter_m;
  Tracker tracker(parameters, camera());
  const auto distances = [&](std::uint64_t first, std::uint64_t count) {
    double sum = 0;
    GreyImage image;
    for (std::uint64_t i = 0; i < count; ++i) {
      renderer.render(scene_of(marker), first + i, image);
      const auto found = tracker.track(image.view());
      REQUIRE(found.size() == 1);
      sum += found[0].pose.position.z() / marker.pose.position.z() - 1;
    }
    return std::abs(sum / static_cast<double>(count));
  };
  CHECK(distances(1, 1) > 4e-4);
  distances(2, 30);
  CHECK(distances(40, 10) < 2.5e-4);
}

TEST_CASE("blur by motion of a twelfth of the diameter moves the pose little") {
  Imaging imaging = usual_imaging();
  imaging.exposure_s = 0.02;
  const double speed = kDiameter / 12 / imaging.exposure_s;
  const Errors errors =
      errors_of(imaging, ResponseCurve::linear(), 0.5, {speed * 0.6, speed * 0.8, 0});
  CHECK(errors.distance < 6e-4);
  CHECK(errors.orientation < 2e-3);
}

TEST_CASE("narrow teeth on a curved rim do not bias the distance of a small marker") {
  for (const double blur : {0.4, 0.7}) {
    CAPTURE(blur);
    constexpr double kAcross = 40;  // pixels
    double bias_px = 0;
    constexpr int kPlaces = 20;
    Random random(3);
    for (int i = 0; i < kPlaces; ++i) {
      const double z = distance_for(kAcross);
      const Eigen::Vector3d place(random.uniform(-0.02, 0.02) * z, random.uniform(-0.02, 0.02) * z,
                                  z);
      const Marker found =
          detected(marker_at(place, 5 * kDegree), imaging(blur, 0), ResponseCurve::linear());
      bias_px += (found.pose.position.z() / z - 1) * kAcross / 2 / kPlaces;
    }
    CHECK(std::abs(bias_px) < 4e-4);  // of the outline: too large or small by so much
  }
}

TEST_CASE("of two poses along the line of sight, one that was fitted to all pixels is told") {
  // Fitted to a quarter of them, some were off by ten of the stated deviations.
  Random random(5);
  for (std::uint64_t i = 0; i < 300; ++i) {
    CAPTURE(i);
    const double z = distance_for(60);
    const Eigen::Vector3d place(random.uniform(-0.02, 0.02) * z, random.uniform(-0.02, 0.02) * z,
                                z);
    const SceneMarker marker =
        marker_at(place, 5 * kDegree, kDiameter, random.uniform(0, 2 * std::numbers::pi));
    const Marker found = detected(marker, imaging(0.4, 3), ResponseCurve::linear(), i);
    const double error = found.pose.position.z() - marker.pose.position.z();
    CHECK(std::abs(error) < 4 * found.sigma_position.z());
  }
}

}  // namespace roundel
