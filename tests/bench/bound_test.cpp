#include "bench/accuracy/bound.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "tests/bench/scene.hpp"

using namespace roundel;
using namespace roundel::bench;

namespace {

PoseCovariance bound_at(double noise_sigma) {
  const Experiment experiment = one_marker(noise_sigma);
  return cramer_rao_bound(experiment, whycode_print(experiment),
                          experiment.views.front().markers.front(), true)
      .value();
}

}  // namespace

TEST_CASE("the bound grows with the noise's variance, rounding included") {
  const double ratio = bound_at(4).trace() / bound_at(1).trace();
  CHECK(ratio == doctest::Approx((16 + 1.0 / 12) / (1 + 1.0 / 12)).epsilon(1e-6));
}

// METHOD.md section 6: one pixel of an edge is known to sqrt(2 sqrt(pi) s) sigma / C pixels;
// sideways half of the outline's pixels count. The inner edges make it better, unknown tilt and
// levels worse.
TEST_CASE("sideways the bound is what the outline's length, contrast and blur give") {
  const Experiment experiment = one_marker(3);
  const double pixel_m = experiment.views.front().markers.front().pose.position.z() / 400;
  const double s = std::sqrt(0.7 * 0.7 + 1.0 / 12);
  const double edge = std::sqrt(2 * std::sqrt(std::numbers::pi) * s) * 3 / (200 - 30);
  const double outline = std::numbers::pi * 60;
  const double expected = edge / std::sqrt(0.5 * outline) * pixel_m;
  const double bound = std::sqrt(bound_at(3)(0, 0));
  CHECK(bound < 1.5 * expected);
  CHECK(bound > 0.5 * expected);
}

// A step in depth along the camera's axis would move such a marker sideways by more than its edges
// are wide.
TEST_CASE("far off the camera's axis distance is known about as well as in the middle") {
  Experiment experiment = one_marker(3);
  experiment.camera.width = 960;
  experiment.camera.cx = 479.5;
  PlacedMarker marker = experiment.views.front().markers.front();
  marker.pose.position = {0, 0, 3};
  marker.pose.orientation = tilted(0.4, 1, 0.3);
  const auto distance_sigma = [&](double angle) {
    const Eigen::Quaterniond aside(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY()));
    PlacedMarker turned = marker;
    turned.pose = {aside * marker.pose.position, aside * marker.pose.orientation};
    const PoseCovariance bound =
        cramer_rao_bound(experiment, whycode_print(experiment), turned, true).value();
    const Eigen::Vector3d sight = turned.pose.position.normalized();
    return std::sqrt(sight.dot(bound.topLeftCorner<3, 3>() * sight));
  };
  // Aside, a marker's image grows by 1/cos^2 of the angle outward, by 1/cos across; of a disc of R
  // pixels, 2 pi R pixels of outline tell R, and the distance as sharply as R.
  const double growth = std::pow(std::cos(0.5), -1.5);
  CHECK(distance_sigma(0.5) ==
        doctest::Approx(distance_sigma(0) * std::pow(growth, -1.5)).epsilon(0.05));
}

TEST_CASE("the floor around the plate tells nothing") {
  Experiment experiment = one_marker(3);
  const Print print = whycode_print(experiment);
  const auto& marker = experiment.views.front().markers.front();
  const double before = cramer_rao_bound(experiment, print, marker, true).value().trace();
  experiment.imaging.floor = 10;
  CHECK(cramer_rao_bound(experiment, print, marker, true).value().trace() ==
        doctest::Approx(before).epsilon(1e-9));
}

TEST_CASE("a ring without a code has no bound for its turn, a code has") {
  const Experiment experiment = one_marker(3);
  const auto& marker = experiment.views.front().markers.front();
  const auto plain = cramer_rao_bound(experiment, whycon_print(experiment), marker, false);
  REQUIRE(plain);
  CHECK((*plain)(5, 5) == 0);
  CHECK(bound_at(3)(5, 5) > 0);
  CHECK_FALSE(cramer_rao_bound(experiment, whycon_print(experiment), marker, true));
}
