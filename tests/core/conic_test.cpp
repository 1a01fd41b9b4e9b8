#include "core/conic.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <numbers>
#include <vector>

#include "tests/random.hpp"

using roundel::CameraModel;
using roundel::circle_poses;
using roundel::CirclePose;
using roundel::fit_conic;
using roundel::test::Random;

namespace {

std::vector<Eigen::Vector2d> project_circle(const CirclePose& pose, double radius, int count) {
  const Eigen::Vector3d x = pose.normal.unitOrthogonal(), y = pose.normal.cross(x);
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < count; ++i) {
    const double t = 2 * std::numbers::pi * i / count;
    const Eigen::Vector3d p = pose.centre + radius * (std::cos(t) * x + std::sin(t) * y);
    points.emplace_back(p.x() / p.z(), p.y() / p.z());
  }
  return points;
}

CirclePose random_pose(Random& random) {
  const Eigen::Vector3d centre(random.uniform(-2, 2), random.uniform(-1.5, 1.5),
                               random.uniform(1, 5));
  // Up to 75 degrees between the normal and the viewing ray.
  const double tilt = random.uniform(0, 75) * std::numbers::pi / 180,
               turn = random.uniform(0, 6.28);
  const Eigen::Vector3d ray = -centre.normalized(), side = ray.unitOrthogonal();
  const Eigen::Vector3d axis = Eigen::AngleAxisd(turn, ray) * side;
  return {centre, Eigen::AngleAxisd(tilt, axis) * ray};
}

}  // namespace

TEST_CASE("one of the two poses of a projected circle is the circle's own") {
  Random random(1);
  for (int i = 0; i < 2000; ++i) {
    const CirclePose truth = random_pose(random);
    const auto conic = fit_conic(project_circle(truth, 0.061, 16));
    REQUIRE(conic.has_value());
    const auto poses = circle_poses(*conic, 0.061);
    REQUIRE(poses.has_value());
    double best = 1e9;
    for (const CirclePose& pose : *poses) {
      CHECK(pose.normal.norm() == doctest::Approx(1).epsilon(1e-12));
      CHECK(pose.normal.dot(pose.centre) < 0);
      CHECK(pose.centre.z() > 0);
      best =
          std::min(best, (pose.centre - truth.centre).norm() + (pose.normal - truth.normal).norm());
    }
    CAPTURE(i);
    CHECK(best < 1e-5);
  }
}

TEST_CASE("both poses of a conic have that conic as their outline") {
  Random random(2);
  for (int i = 0; i < 200; ++i) {
    const auto conic = fit_conic(project_circle(random_pose(random), 0.1, 12));
    const auto poses = circle_poses(*conic, 0.1);
    REQUIRE(poses.has_value());
    const Eigen::Matrix3d scaled = *conic / conic->norm();
    for (const CirclePose& pose : *poses) {
      for (const Eigen::Vector2d& p : project_circle(pose, 0.1, 7)) {
        CHECK(std::abs(p.homogeneous().dot(scaled * p.homogeneous())) < 1e-9);
      }
    }
  }
}

TEST_CASE("a conic that is no ellipse has no pose") {
  CHECK_FALSE(circle_poses(Eigen::Matrix3d::Identity(), 0.1).has_value());
  const std::vector<Eigen::Vector2d> line = {{0, 0}, {1, 1}, {2, 2}, {3, 3}, {4, 4}, {5, 5}};
  CHECK_FALSE(fit_conic(line).has_value());
  const std::vector<Eigen::Vector2d> four = {{0, 1}, {1, 0}, {0, -1}, {-1, 0}};
  CHECK_FALSE(fit_conic(four).has_value());
}
