#include "calibration/homography.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>

#include "tests/random.hpp"

using namespace roundel;

namespace {

Pose random_pose(test::Random& random) {
  Pose pose;
  pose.position = {random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), random.uniform(0.5, 3)};
  const Eigen::Vector3d axis =
      Eigen::Vector3d(random.gaussian(), random.gaussian(), random.gaussian()).normalized();
  pose.orientation = with_positive_w(Eigen::AngleAxisd(random.uniform(0, 0.9), axis) *
                                     Eigen::Quaterniond(0, 1, 0, 0));
  return pose;
}

std::vector<PlanePoint> seen_from(const Pose& pose, int count, test::Random& random) {
  std::vector<PlanePoint> points;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector2d at(random.uniform(-0.15, 0.15), random.uniform(-0.1, 0.1));
    points.push_back({at, pose.to_camera({at.x(), at.y(), 0}).hnormalized()});
  }
  return points;
}

}  // namespace

TEST_CASE("a plane's pose comes back from the homography of points seen in it") {
  test::Random random(3);
  for (int i = 0; i < 100; ++i) {
    const Pose pose = random_pose(random);
    const auto points = seen_from(pose, random.integer(4, 30), random);
    const auto homography = fit_homography(points);
    REQUIRE(homography);
    for (const PlanePoint& point : points)
      CHECK((apply(*homography, point.on_plane) - point.seen).norm() < 1e-7);
    const auto found = pose_from_homography(*homography);
    REQUIRE(found);
    CHECK((found->position - pose.position).norm() < 1e-5);
    CHECK(orientation_error(found->orientation, pose.orientation) < 1e-5);
  }
}

TEST_CASE("too few points, points on a line or in one place have no homography") {
  test::Random random(4);
  auto points = seen_from(random_pose(random), 20, random);
  CHECK_FALSE(fit_homography(std::span(points).first(3)));
  for (PlanePoint& point : points) point.on_plane.y() = 2 * point.on_plane.x();
  CHECK_FALSE(fit_homography(points));
  for (PlanePoint& point : points) point = points[0];
  CHECK_FALSE(fit_homography(points));
}

TEST_CASE("the consensus leaves out points that lie elsewhere, up to a third of them") {
  test::Random random(5);
  for (int i = 0; i < 50; ++i) {
    auto points = seen_from(random_pose(random), 24, random);
    const std::size_t wrong = static_cast<std::size_t>(random.integer(0, 8));
    for (std::size_t k = 0; k < wrong; ++k)
      points[k].seen += Eigen::Vector2d(random.uniform(0.05, 0.3), random.uniform(0.05, 0.3));
    const auto kept = consensus(points, 0.01);
    for (std::size_t k = 0; k < points.size(); ++k) CHECK(kept[k] == (k >= wrong));
  }
}
