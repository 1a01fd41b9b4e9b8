#include "core/camera_model.hpp"

#include <doctest/doctest.h>

#include <limits>

#include "tests/random.hpp"

using roundel::CameraModel;

namespace {

CameraModel webcam() {
  CameraModel camera;
  camera.width = 1920;
  camera.height = 1080;
  camera.fx = 1452;
  camera.fy = 1455;
  camera.cx = 961.2;
  camera.cy = 538.7;
  camera.distortion = {-0.28, 0.09, 0.0006, -0.0009, -0.012};
  return camera;
}

}  // namespace

TEST_CASE("the lens is removed and applied again to within 1e-9 over the whole image and beyond") {
  const CameraModel camera = webcam();
  for (int v = -100; v < 1180; v += 20) {
    for (int u = -100; u < 2020; u += 20) {
      const Eigen::Vector2d distorted = camera.from_pixel({double(u), double(v)});
      const auto normalised = camera.undistort(distorted);
      REQUIRE(normalised.has_value());
      CHECK((camera.distort(*normalised) - distorted).norm() < 1e-12);
    }
  }
  for (double x = -0.9; x < 0.9; x += 0.05) {
    for (double y = -0.6; y < 0.6; y += 0.05) {
      const auto back = camera.undistort(camera.distort({x, y}));
      REQUIRE(back.has_value());
      CHECK((*back - Eigen::Vector2d(x, y)).norm() < 1e-9);
    }
  }
}

TEST_CASE("the lens follows the plumb-bob formula") {
  CameraModel camera;
  camera.distortion = {0.1, 0.02, 0.003, 0.004, 0.0005};
  // Worked out by hand for (0.5, -0.25): r2 = 0.3125.
  const double radial = 1 + 0.1 * 0.3125 + 0.02 * 0.09765625 + 0.0005 * 0.030517578125;
  const Eigen::Vector2d expected(
      0.5 * radial + 2 * 0.003 * 0.5 * -0.25 + 0.004 * (0.3125 + 2 * 0.25),
      -0.25 * radial + 0.003 * (0.3125 + 2 * 0.0625) + 2 * 0.004 * 0.5 * -0.25);
  CHECK((camera.distort({0.5, -0.25}) - expected).norm() < 1e-15);
}

TEST_CASE("the derivative of the lens agrees with finite differences") {
  const CameraModel camera = webcam();
  roundel::test::Random random(3);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector2d x(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5));
    const Eigen::Matrix2d jacobian = camera.distort_jacobian(x);
    constexpr double kStep = 1e-6;
    for (int axis = 0; axis < 2; ++axis) {
      const Eigen::Vector2d step = kStep * Eigen::Vector2d::Unit(axis);
      const Eigen::Vector2d slope =
          (camera.distort(x + step) - camera.distort(x - step)) / (2 * kStep);
      CHECK((slope - jacobian.col(axis)).norm() < 1e-8);
    }
  }
}

TEST_CASE("beyond the fold of the lens model there is no image and no inverse") {
  CameraModel camera = webcam();
  camera.distortion = {-0.3, 0, 0, 0, 0};  // folds at r = 1.054, image radius 0.703
  CHECK(camera.undistort({0.69, 0}).has_value());
  CHECK_FALSE(camera.undistort({0.75, 0}).has_value());
  CHECK(camera.project({1.0, 0, 1}).has_value());
  CHECK_FALSE(camera.project({1.5, 0, 1}).has_value());
  CHECK_FALSE(camera.undistort({1e300, 0}).has_value());
  CHECK_FALSE(camera.undistort({std::numeric_limits<double>::quiet_NaN(), 0}).has_value());
}

TEST_CASE("points behind the camera have no image") {
  const CameraModel camera = webcam();
  CHECK_FALSE(camera.project({0, 0, -1}).has_value());
  CHECK_FALSE(camera.project({0, 0, 0}).has_value());
  const auto centre = camera.project({0, 0, 2});
  REQUIRE(centre.has_value());
  CHECK(centre->x() == doctest::Approx(961.2));
  CHECK(centre->y() == doctest::Approx(538.7));
}
