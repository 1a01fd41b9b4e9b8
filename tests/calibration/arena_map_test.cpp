#include "calibration/arena_map.hpp"

#include <doctest/doctest.h>

#include "calibration/arena_pose_fit.hpp"
#include "tests/calibration/arena_scene.hpp"

using namespace roundel;
using namespace roundel::test;

namespace {

MarkerMounts at_height(double height) {
  MarkerMounts mounts;
  mounts.usual.height_m = height;
  return mounts;
}

double turn(double a, double b) {
  return std::abs(std::remainder(a - b, 2 * std::numbers::pi));
}

}  // namespace

TEST_CASE("in 2D a marker above the floor is found where it stands, whatever its distance says") {
  ArenaScene scene(0.3, 0.35);
  const ArenaMap map(calibrated(scene), ArenaMode::k2D, at_height(0.12));
  for (const double heading : {-3.0, -1.2, 0.0, 0.7, 2.5}) {
    Marker marker = scene.marker(7, {2.4, 0.3, 0.12}, heading);
    marker.pose.position *= 1.03;  // gamma makes it look farther away
    const ArenaPose pose = map.locate(marker);
    REQUIRE(pose.valid);
    CHECK(pose.position.x() == doctest::Approx(2.4).epsilon(0.0001));
    CHECK(pose.position.y() == doctest::Approx(0.3).epsilon(0.0005));
    CHECK(pose.position.z() == 0.12);
    CHECK(turn(pose.heading, heading) < 0.001);
    CHECK(pose.sigma_position.z() == 0);
  }
  // Taken for a marker on the floor, it would be centimetres off.
  const ArenaMap flat(calibrated(scene), ArenaMode::k2D, {});
  const Eigen::Vector3d wrong = flat.locate(scene.marker(7, {2.4, 0.3, 0.12})).position;
  CHECK((wrong.head<2>() - Eigen::Vector2d(2.4, 0.3)).norm() > 0.02);
}

TEST_CASE("in 3D a marker's pose is moved into the arena's frame") {
  ArenaScene scene(0.3, 0.35);
  const ArenaMap map(calibrated(scene), ArenaMode::k3D, at_height(0.12));
  const ArenaPose pose = map.locate(scene.marker(7, {1.2, 1.7, 0.31}, 1.1));
  REQUIRE(pose.valid);
  CHECK((pose.position - Eigen::Vector3d(1.2, 1.7, 0.31)).norm() < 0.004);
  CHECK(turn(pose.heading, 1.1) < 0.001);
  CHECK(pose.sigma_position.z() > 0.0005);
}

TEST_CASE("a mount's offset and rotation are taken off, so that the robot's centre is reported") {
  ArenaScene scene;
  MarkerMounts mounts = at_height(0.05);
  MarkerMount mount;
  mount.height_m = 0.10;
  mount.offset_x_m = 0.04;  // the marker sits ahead of the robot's centre
  mount.offset_y_m = -0.02;
  mount.rotation = 0.5;
  mounts.by_id.push_back({7, mount});
  for (const ArenaMode mode : {ArenaMode::k2D, ArenaMode::k3D}) {
    const ArenaMap map(calibrated(scene), mode, mounts);
    const double robot_heading = 2.0, c = std::cos(2.0), s = std::sin(2.0);
    const Eigen::Vector3d marker_at(1 + c * 0.04 + s * 0.02, 0.5 + s * 0.04 - c * 0.02, 0.10);
    const ArenaPose pose = map.locate(scene.marker(7, marker_at, robot_heading + 0.5));
    CHECK((pose.position - Eigen::Vector3d(1, 0.5, 0.10)).norm() < 0.003);
    CHECK(turn(pose.heading, robot_heading) < 0.002);
  }
  // Others wear theirs as usual.
  const ArenaMap map(calibrated(scene), ArenaMode::k2D, mounts);
  CHECK((map.locate(scene.marker(8, {1, 0.5, 0.05})).position - Eigen::Vector3d(1, 0.5, 0.05))
            .norm() < 0.0005);
}

TEST_CASE("the floor tells which of two poses is right") {
  ArenaScene scene(0, 0.3);
  const ArenaMap map(calibrated(scene), ArenaMode::k2D, {});
  const Marker right = scene.marker(7, {2.8, 1.8, 0}, 0.4);
  // The other pose with this outline is mirrored at the ray: its normal leans the other way.
  Marker wrong = right;
  const Eigen::Vector3d ray = right.pose.position.normalized();
  const Eigen::Vector3d axis = ray.cross(right.pose.normal()).normalized();
  const double lean = std::acos(-ray.dot(right.pose.normal()));
  const Eigen::Quaterniond flip(Eigen::AngleAxisd(2 * lean, axis));
  wrong.pose.orientation = with_positive_w((flip * right.pose.orientation).normalized());
  REQUIRE(wrong.pose.normal().dot(right.pose.normal()) < 0.9);
  wrong.has_alternative = true;
  wrong.alternative = right.pose;
  wrong.ambiguity = 0.01;  // the picture was for the wrong one
  CHECK(turn(map.locate(wrong).heading, 0.4) < 0.001);
  // In 3D nothing is known of the floor, and the tracker's choice stands.
  const ArenaMap space(calibrated(scene), ArenaMode::k3D, {});
  CHECK(turn(space.locate(wrong).heading, 0.4) > 0.01);
}

TEST_CASE("corner markers stay on the floor when robots' markers are higher") {
  ArenaScene scene;
  const ArenaMap map(calibrated(scene), ArenaMode::k2D, at_height(0.12));
  const ArenaPose pose = map.locate(scene.marker(-1, {3, 2, 0}));
  CHECK((pose.position - Eigen::Vector3d(3, 2, 0)).norm() < 0.0005);
}

TEST_CASE("a marker without a readable code has a position and no heading") {
  ArenaScene scene;
  for (const ArenaMode mode : {ArenaMode::k2D, ArenaMode::k3D}) {
    const ArenaMap map(calibrated(scene), mode, {});
    const ArenaPose pose = map.locate(scene.marker(-1, {1, 1, 0}, 1.0));
    CHECK(pose.valid);
    CHECK(pose.heading == 0);
    CHECK(pose.sigma_heading == doctest::Approx(std::numbers::pi));
  }
}

TEST_CASE("what is no pose or does not meet the floor is not located") {
  ArenaScene scene;
  const ArenaMap map(calibrated(scene), ArenaMode::k2D, {});
  Marker marker = scene.marker(7, {1, 1, 0});
  marker.has_pose = false;
  CHECK_FALSE(map.locate(marker).valid);
  // A ray that goes up past the horizon.
  const ArenaScene tilted(0, 1.2);
  CHECK(on_plane(tilted.arena_in_camera(), {0.0, 0.0}, 0).has_value());
  CHECK_FALSE(on_plane(tilted.arena_in_camera(), {0.0, 1.5}, 0).has_value());
}

TEST_CASE("stated deviations hold for noise in the markers") {
  ArenaScene scene(0.2, 0.3);
  const ArenaCalibration calibration = calibrated(scene);
  Random random(3);
  const double focal = scene.camera().fx;
  ArenaMap map(calibration, ArenaMode::k2D, {});
  int within = 0, heading_within = 0;
  constexpr int kTimes = 2000;
  for (int i = 0; i < kTimes; ++i) {
    const Eigen::Vector3d place(random.uniform(0, 3), random.uniform(0, 2), 0);
    Marker marker = scene.marker(7, place, 0.3);
    // Noise of an outline: much along the ray, little across (see arena_map.cpp).
    marker.pose = {scene.arena_in_camera().to_camera(place), scene.arena_in_camera().orientation};
    const double distance = marker.pose.position.norm();
    const double along = 0.002, across = std::sqrt(0.5) * 0.061 / distance * along;
    const Eigen::Vector3d ray = marker.pose.position / distance;
    const Eigen::Vector3d noise(random.gaussian(), random.gaussian(), random.gaussian());
    marker.ellipse.a = 0.061 / distance * focal;
    marker.pose.position += across * (noise - noise.dot(ray) * ray) + along * noise.dot(ray) * ray;
    marker.sigma_position = (along * along * ray.cwiseAbs2() +
                             across * across * (Eigen::Vector3d::Ones() - ray.cwiseAbs2()))
                                .cwiseSqrt();
    const double yaw = 0.002 * random.gaussian();
    marker.sigma_rotation = Eigen::Vector3d::Constant(0.002);
    marker.pose.orientation =
        marker.pose.orientation * Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ());
    const ArenaPose found = map.locate(marker);
    const Eigen::Vector3d off = found.position - place;
    within += std::abs(off.x()) < found.sigma_position.x() ? 1 : 0;
    heading_within += std::abs(found.heading) < found.sigma_heading ? 1 : 0;
  }
  CHECK(within > 0.60 * kTimes);
  CHECK(within < 0.76 * kTimes);
  CHECK(heading_within > 0.60 * kTimes);
  CHECK(heading_within < 0.76 * kTimes);
}
