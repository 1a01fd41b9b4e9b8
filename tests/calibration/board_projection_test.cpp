#include "calibration/board_projection.hpp"

#include <doctest/doctest.h>

#include "tests/calibration/synthetic_views.hpp"

using namespace roundel;

namespace {

// Central differences of the pixel over one parameter.
template <typename Pixel>
Eigen::Vector2d slope(Pixel&& pixel, double step) {
  return (pixel(step) - pixel(-step)) / (2 * step);
}

}  // namespace

TEST_CASE("the derivatives of a board's image are those of small steps") {
  test::Random random(8);
  for (int i = 0; i < 40; ++i) {
    const test::SyntheticViews views(Board{}, test::webcam(), static_cast<std::uint64_t>(i));
    const CameraModel& camera = views.camera;
    const Pose pose =
        views.pose({random.uniform(200, 1700), random.uniform(100, 900)}, random.uniform(0, 0.8),
                   random.uniform(0, 6), random.uniform(0, 6), random.uniform(0.2, 0.9));
    const Eigen::Vector3d place(random.uniform(-0.1, 0.1), random.uniform(-0.05, 0.05),
                                random.uniform(-0.005, 0.005));
    const auto projection = project_board_point(camera, pose, place);
    REQUIRE(projection);
    CHECK((projection->pixel - *board_pixel(camera, pose, place)).norm() < 1e-12);
    CHECK((projection->pixel - *camera.project(pose.to_camera(place))).norm() < 1e-9);
    for (int k = 0; k < kIntrinsicParameters; ++k) {
      CAPTURE(k);
      const auto numeric = slope(
          [&](double step) {
            IntrinsicVector v = to_vector(camera);
            v[k] += step;
            return *board_pixel(to_camera(v, camera), pose, place);
          },
          1e-5);
      CHECK((projection->by_intrinsics.col(k) - numeric).norm() < 1e-5 * (1 + numeric.norm()));
    }
    for (int k = 0; k < 6; ++k) {
      CAPTURE(k);
      const auto numeric = slope(
          [&](double step) {
            return *board_pixel(camera, moved(pose, step * PoseStep::Unit(k)), place);
          },
          1e-6);
      CHECK((projection->by_pose.col(k) - numeric).norm() < 1e-5 * (1 + numeric.norm()));
    }
    for (int k = 0; k < 3; ++k) {
      CAPTURE(k);
      const auto numeric = slope(
          [&](double step) {
            return *board_pixel(camera, pose, place + step * Eigen::Vector3d::Unit(k));
          },
          1e-6);
      CHECK((projection->by_place.col(k) - numeric).norm() < 1e-5 * (1 + numeric.norm()));
    }
  }
}

TEST_CASE("a point behind the camera has no image") {
  Pose pose;
  pose.position = {0, 0, -1};
  CHECK_FALSE(project_board_point(test::webcam(), pose, {0, 0, 0}));
  CHECK_FALSE(board_pixel(test::webcam(), pose, {0, 0, 0}));
}
