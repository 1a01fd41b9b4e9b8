#include "core/detector.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <numbers>
#include <vector>

#include "core/conic.hpp"
#include "core/necklace.hpp"
#include "core/plane_projection.hpp"
#include "tests/painter.hpp"

using namespace roundel;  // NOLINT(google-build-using-namespace)
using roundel::test::Painter;
using roundel::test::Print;
using roundel::test::Random;

namespace {

constexpr double kDegree = std::numbers::pi / 180;

CameraModel small_camera() {
  CameraModel camera;
  camera.width = 320;
  camera.height = 240;
  camera.fx = 600;
  camera.fy = 602;
  camera.cx = 158;
  camera.cy = 121;
  camera.distortion = {-0.28, 0.09, 0.0006, -0.0009, -0.012};
  return camera;
}

Pose pose_at(const Eigen::Vector3d& centre, double tilt, double tilt_direction, double yaw) {
  const Eigen::Vector3d ray = -centre.normalized();
  const Eigen::Vector3d axis = Eigen::AngleAxisd(tilt_direction, ray) * ray.unitOrthogonal();
  return pose_from_circle({centre, Eigen::AngleAxisd(tilt, axis) * ray}, yaw);
}

}  // namespace

TEST_CASE("a code marker comes back with its pose, id and turn over tilts and places") {
  const CameraModel camera = small_camera();
  const NecklaceCode code(8, 1);
  Detector detector({}, camera);
  Random random(11);
  double position_sum = 0, orientation_sum = 0, worst_position = 0, worst_orientation = 0;
  constexpr int kPoses = 150;
  for (int i = 0; i < kPoses; ++i) {
    CAPTURE(i);
    const double z = random.uniform(0.7, 1.4);
    const Eigen::Vector3d centre(z * random.uniform(-0.13, 0.13), z * random.uniform(-0.08, 0.08),
                                 z);
    const double tilt = random.uniform(0, 60) * kDegree;
    const Pose truth = pose_at(centre, tilt, random.uniform(0, 6.28), random.uniform(-3.1, 3.1));
    const int id = random.integer(1, 30);
    Painter painter(camera, {});
    painter.add({8, *code.word(id)}, truth);
    const auto markers = detector.detect(painter.view());
    REQUIRE(markers.size() == 1);
    const Marker& marker = markers[0];
    CHECK(marker.id == id);
    CHECK(marker.id_probability > 0.99);
    REQUIRE(marker.has_pose);
    CHECK(marker.pose.orientation.w() >= 0);
    CHECK(marker.pose.orientation.norm() == doctest::Approx(1));
    CHECK((*camera.project(truth.position) - Eigen::Vector2d(marker.u, marker.v)).norm() < 0.2);
    const double position = (marker.pose.position - truth.position).norm() / z;
    const double orientation = orientation_error(marker.pose.orientation, truth.orientation);
    worst_position = std::max(worst_position, position);
    worst_orientation = std::max(worst_orientation, orientation);
    position_sum += position;
    orientation_sum += orientation;
  }
  CHECK(position_sum / kPoses < 0.0015);  // of the distance
  CHECK(worst_position < 0.008);
  CHECK(orientation_sum / kPoses < 0.006);
  CHECK(worst_orientation < 0.05);  // frontal views; a flip would be several times as much
}

TEST_CASE("a plain marker of any printed ratio has a pose, no id and the neutral turn") {
  const CameraModel camera = small_camera();
  Random random(12);
  for (const int bits : {0, 6, 8}) {
    DetectorParameters parameters;
    parameters.bits = bits;
    Detector detector(parameters, camera);
    for (const double ratio : {0.333, 50.0 / 122.0, 0.4714, 0.53, 0.60}) {
      for (int i = 0; i < 8; ++i) {
        CAPTURE(bits);
        CAPTURE(ratio);
        CAPTURE(i);
        const double tilt = random.uniform(12, 55) * kDegree;
        const Pose truth = pose_at({random.uniform(-0.1, 0.1), random.uniform(-0.08, 0.08), 1.0},
                                   tilt, random.uniform(0, 6.28), 0);
        Painter painter(camera, {});
        painter.add({.inner_ratio = ratio}, truth);
        const auto markers = detector.detect(painter.view());
        REQUIRE(markers.size() == 1);
        CHECK(markers[0].id == -1);
        CHECK(markers[0].id_probability == 0);
        CHECK(orientation_error(markers[0].pose.orientation, truth.orientation) < 0.03);
        // No yaw: the marker's x axis lies under the camera's x axis.
        const Eigen::Vector3d x = markers[0].pose.orientation * Eigen::Vector3d::UnitX();
        const Eigen::Vector3d y = markers[0].pose.orientation * Eigen::Vector3d::UnitY();
        CHECK(x.x() > 0);
        CHECK(std::abs(y.x()) < 1e-9);
      }
    }
  }
}

TEST_CASE("a marker cut by the image border is not reported") {
  const CameraModel camera = small_camera();
  const NecklaceCode code(8, 1);
  Detector detector({}, camera);
  int whole = 0;
  for (double x = -0.14; x > -0.26; x -= 0.004) {
    const Pose truth = pose_at({x, 0, 0.9}, 0.2, 1, 0.5);
    Painter painter(camera, {});
    painter.add({8, *code.word(5)}, truth);
    // The outline's leftmost point, by projection.
    double left = 1e9;
    for (int i = 0; i < 64; ++i) {
      const double t = i * std::numbers::pi / 32, r = kDefaultDiameter / 2;
      left = std::min(left,
                      camera.project(truth.to_camera({r * std::cos(t), r * std::sin(t), 0}))->x());
    }
    const auto markers = detector.detect(painter.view());
    CAPTURE(left);
    if (left < 0) CHECK(markers.empty());
    if (left > 2) {
      CHECK(markers.size() == 1);
      ++whole;
    }
  }
  CHECK(whole > 3);
}

TEST_CASE("a marker under a hard shadow or a steep gradient of light is found and read") {
  const CameraModel camera = small_camera();
  const NecklaceCode code(8, 1);
  Detector detector({}, camera);
  const Pose truth = pose_at({0.01, -0.02, 0.9}, 0.3, 2, 1.0);
  for (const bool hard : {false, true}) {
    CAPTURE(hard);
    Painter painter(camera, {});
    painter.add({8, *code.word(17)}, truth);
    GreyImage& image = painter.image();
    for (int v = 0; v < image.height; ++v) {
      for (int u = 0; u < image.width; ++u) {
        std::uint8_t& pixel = image.at(u, v);
        const double light = hard ? (u + v / 3 < 200 ? 1.0 : 0.55) : 1.1 - 0.8 * u / image.width;
        pixel = static_cast<std::uint8_t>(std::min(255.0, pixel * light));
      }
    }
    const auto markers = detector.detect(painter.view());
    REQUIRE(markers.size() == 1);
    CHECK(markers[0].id == 17);
    CHECK((markers[0].pose.position - truth.position).norm() < 0.02);
  }
}

TEST_CASE("packed and padded buffers give the same markers as plain grey") {
  const CameraModel camera = small_camera();
  const NecklaceCode code(8, 1);
  Painter painter(camera, {});
  painter.add({8, *code.word(9)}, pose_at({0.05, 0.02, 0.9}, 0.4, 1, 2));
  painter.add_noise(3, 5);
  const LumaView grey = painter.view();
  const int stride = 2 * grey.width + 24;
  std::vector<std::uint8_t> yuyv(static_cast<std::size_t>(stride * grey.height), 128);
  std::vector<std::uint8_t> uyvy = yuyv, padded = yuyv, triple(yuyv.size() * 2, 77);
  for (int v = 0; v < grey.height; ++v) {
    for (int u = 0; u < grey.width; ++u) {
      yuyv[static_cast<std::size_t>(v * stride + 2 * u)] = grey.at(u, v);
      uyvy[static_cast<std::size_t>(v * stride + 2 * u + 1)] = grey.at(u, v);
      padded[static_cast<std::size_t>(v * stride + u)] = grey.at(u, v);
      triple[static_cast<std::size_t>(v * 2 * stride + 3 * u)] = grey.at(u, v);
    }
  }
  Detector detector({}, camera);
  const Marker expected = detector.detect(grey)[0];
  REQUIRE(expected.id == 9);
  const int w = grey.width, h = grey.height;
  for (const LumaView& view :
       {yuyv_view(yuyv.data(), w, h, stride), uyvy_view(uyvy.data(), w, h, stride),
        grey_view(padded.data(), w, h, stride), LumaView{triple.data(), w, h, 2 * stride, 3}}) {
    const auto markers = detector.detect(view);
    REQUIRE(markers.size() == 1);
    CHECK(markers[0].id == expected.id);
    CHECK(markers[0].pose.position == expected.pose.position);
    CHECK(markers[0].pose.orientation.coeffs() == expected.pose.orientation.coeffs());
  }
}

TEST_CASE("a ring whose teeth are no code of the set gets no id") {
  const CameraModel camera = small_camera();
  DetectorParameters parameters;
  parameters.hamming = 3;  // ids 1 to 3: words 1, 15, 55
  Detector detector(parameters, camera);
  const NecklaceCode all(8, 1), few(8, 3);
  int others = 0;
  for (int id = 1; id <= all.id_count(); ++id) {
    CAPTURE(id);
    Painter painter(camera, {});
    painter.add({8, *all.word(id)}, pose_at({0.02, 0.01, 0.8}, 0.3, 1, 0.1 * id));
    const auto markers = detector.detect(painter.view());
    REQUIRE(markers.size() == 1);
    const auto expected = few.decode(*all.word(id));
    CHECK(markers[0].id == (expected ? expected->id : -1));
    others += expected ? 0 : 1;
  }
  CHECK(others == 27);
}

TEST_CASE("teeth that pair to no Manchester code are not silently accepted") {
  const CameraModel camera = small_camera();
  const NecklaceCode code(8, 1);
  Detector detector({}, camera);
  const Pose truth = pose_at({0.0, 0.0, 0.7}, 0.2, 1, 0.3);
  for (int tooth = 0; tooth < 16; ++tooth) {
    CAPTURE(tooth);
    Painter painter(camera, {});
    painter.add({8, *code.word(11)}, truth);
    // One half-tooth takes the other colour, as dirt or a wrong print would have it.
    GreyImage& image = painter.image();
    for (int v = 0; v < image.height; ++v) {
      for (int u = 0; u < image.width; ++u) {
        const auto ray = camera.normalise({double(u), double(v)});
        const Eigen::Vector3d eye = truth.orientation.conjugate() * -truth.position;
        const Eigen::Vector3d direction = truth.orientation.conjugate() * ray->homogeneous();
        const Eigen::Vector3d hit = eye - direction * (eye.z() / direction.z());
        const double r = hit.head<2>().norm() / (kDefaultDiameter / 2);
        double turn = std::atan2(hit.y(), hit.x()) / (2 * std::numbers::pi);
        if (turn < 0) turn += 1;
        if (r < kCodeInnerRatio || r > kCodeOuterRatio || int(turn * 16) != tooth) continue;
        std::uint8_t& pixel = image.at(u, v);
        pixel = static_cast<std::uint8_t>(250 - pixel);
      }
    }
    const auto markers = detector.detect(painter.view());
    REQUIRE(markers.size() == 1);
    CHECK(markers[0].id == -1);
  }
}

TEST_CASE("shapes that are no markers are not reported") {
  const CameraModel camera = small_camera();
  Detector detector({}, camera);
  Painter painter(camera, {});
  GreyImage& image = painter.image();
  const auto fill = [&](int u0, int v0, int u1, int v1, int level) {
    for (int v = v0; v < v1; ++v) {
      for (int u = u0; u < u1; ++u) {
        image.at(u, v) = static_cast<std::uint8_t>(level);
      }
    }
  };
  fill(10, 10, 90, 90, 215);  // a white sheet with a black square frame
  fill(20, 20, 80, 80, 35);
  fill(35, 35, 65, 65, 215);
  fill(110, 10, 190, 90, 215);  // stripes
  for (int u = 115; u < 185; u += 14) fill(u, 12, u + 7, 88, 35);
  for (int v = 110; v < 230; v += 12) {  // a checkerboard
    for (int u = 20; u < 140; u += 12) fill(u, v, u + 12, v + 12, (u + v) / 12 % 2 ? 215 : 35);
  }
  for (int v = 110; v < 230; ++v) {  // discs without and rings with a cut
    for (int u = 150; u < 310; ++u) {
      const double first = std::hypot(u - 190, v - 150), second = std::hypot(u - 260, v - 170);
      if (first < 50) fill(u, v, u + 1, v + 1, first < 36 ? 35 : 215);
      if (second < 48) {
        const bool ring = second < 36 && second > 16 && !(u > 260 && std::abs(v - 170) < 5);
        fill(u, v, u + 1, v + 1, ring ? 35 : 215);
      }
    }
  }
  painter.add_noise(3, 3);
  CHECK(detector.detect(painter.view()).empty());
}

TEST_CASE("an empty frame, one of a single grey and one of noise hold no marker") {
  const CameraModel camera = small_camera();
  Detector detector({}, camera);
  Painter painter(camera, {});
  CHECK(detector.detect(painter.view()).empty());
  for (const double sigma : {3.0, 20.0, 90.0}) {
    Painter noisy(camera, {});
    noisy.add_noise(sigma, 4);
    CAPTURE(sigma);
    CHECK(detector.detect(noisy.view()).empty());
  }
  GreyImage tiny;
  for (const auto& [w, h] : {std::pair{1, 1}, std::pair{2, 1}, std::pair{1, 50}, std::pair{9, 3}}) {
    tiny.resize(w, h);
    CHECK(Detector({}, std::nullopt).detect(tiny.view()).empty());
  }
}

TEST_CASE("without a camera markers have their id and outline but no pose") {
  const CameraModel camera = small_camera();
  const NecklaceCode code(8, 1);
  Detector detector({}, std::nullopt);
  Painter painter(camera, {});
  const Pose truth = pose_at({0.05, 0.02, 0.8}, 0.35, 1, 2);
  painter.add({8, *code.word(21)}, truth);
  const auto markers = detector.detect(painter.view());
  REQUIRE(markers.size() == 1);
  CHECK(markers[0].id == 21);
  CHECK_FALSE(markers[0].has_pose);
  // The ellipse's centre, which perspective shifts off the image of the marker's centre.
  const Eigen::Vector2d centre = *camera.project(truth.position);
  CHECK((centre - Eigen::Vector2d(markers[0].u, markers[0].v)).norm() < 2);
}

TEST_CASE("a frame of another resolution than the camera's is refused with both") {
  Detector detector({}, small_camera());
  GreyImage image;
  image.resize(640, 480);
  CHECK_THROWS_WITH_AS(detector.detect(image.view()), doctest::Contains("320x240"),
                       std::invalid_argument);
  CHECK_THROWS_WITH_AS(detector.detect(image.view()), doctest::Contains("640x480"),
                       std::invalid_argument);
}

TEST_CASE("parameters out of range are refused by name") {
  DetectorParameters parameters;
  parameters.diameter_m = 0;
  CHECK_THROWS_WITH_AS(Detector(parameters, std::nullopt), doctest::Contains("diameter"),
                       std::invalid_argument);
  parameters = {};
  parameters.bits = 17;
  CHECK_THROWS_AS(Detector(parameters, std::nullopt), std::invalid_argument);
  parameters = {};
  parameters.hamming = 5;
  CHECK_THROWS_AS(Detector(parameters, std::nullopt), std::invalid_argument);
  parameters = {};
  parameters.max_markers = 0;
  CHECK_THROWS_AS(Detector(parameters, std::nullopt), std::invalid_argument);
}
