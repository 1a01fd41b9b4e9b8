// What cameras do to pictures of markers, one thing at a time.
#include <doctest/doctest.h>

#include <algorithm>
#include <numbers>
#include <vector>

#include "core/detector.hpp"
#include "core/necklace.hpp"
#include "core/plane_projection.hpp"
#include "tests/jpeg_bytes.hpp"
#include "tests/painter.hpp"

using namespace roundel;  // NOLINT(google-build-using-namespace)
using roundel::test::Paint;
using roundel::test::Painter;

namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr int kId = 11;

// Without distortion: what is tried here does not depend on it.
CameraModel camera_of(int width, int height, double focal) {
  CameraModel camera;
  camera.width = width;
  camera.height = height;
  camera.fx = camera.fy = focal;
  camera.cx = (width - 1) / 2.0;
  camera.cy = (height - 1) / 2.0;
  return camera;
}

Pose pose_at(const Eigen::Vector3d& centre, double tilt, double yaw) {
  const Eigen::Vector3d ray = -centre.normalized();
  const Eigen::Vector3d axis = Eigen::AngleAxisd(0.7, ray) * ray.unitOrthogonal();
  return pose_from_circle({centre, Eigen::AngleAxisd(tilt, axis) * ray}, yaw);
}

// The distance at which the default marker is so many pixels across.
double distance_for(double pixels, const CameraModel& camera) {
  return camera.fx * kDefaultDiameter / pixels;
}

// The picture after a camera that sends JPEG.
void compress(GreyImage& picture, int quality) {
  const std::vector<std::uint8_t> bytes = jpeg_bytes(picture, quality);
  jpeg_error_mgr errors;
  jpeg_decompress_struct info;
  info.err = jpeg_std_error(&errors);
  jpeg_create_decompress(&info);
  jpeg_mem_src(&info, bytes.data(), bytes.size());
  jpeg_read_header(&info, TRUE);
  info.out_color_space = JCS_GRAYSCALE;
  jpeg_start_decompress(&info);
  while (info.output_scanline < info.output_height) {
    JSAMPROW row =
        picture.pixels.data() + static_cast<std::size_t>(info.output_scanline) * info.output_width;
    jpeg_read_scanlines(&info, &row, 1);
  }
  jpeg_finish_decompress(&info);
  jpeg_destroy_decompress(&info);
}

void check_found(const Painter& painter, const CameraModel& camera, const Pose& truth,
                 double max_position_share) {
  Detector detector({}, camera);
  const auto markers = detector.detect(painter.view());
  REQUIRE(markers.size() == 1);
  CHECK(markers[0].id == kId);
  CHECK((markers[0].pose.position - truth.position).norm() <
        max_position_share * truth.position.norm());
}

void check_code(const CameraModel& camera, const Paint& paint, const Pose& truth, int blurs,
                double max_position_share) {
  Painter painter(camera, paint);
  painter.add({8, *NecklaceCode(8, 1).word(kId)}, truth);
  painter.blur(blurs);
  painter.add_noise(2, 5);
  check_found(painter, camera, truth, max_position_share);
}

}  // namespace

TEST_CASE("a marker is found with its id from 14 to 800 pixels across") {
  const CameraModel small = camera_of(320, 240, 600), large = camera_of(940, 940, 1200);
  check_code(small, {}, pose_at({0.02, 0.01, distance_for(14, small)}, 0.2, 0.4), 0, 0.03);
  check_code(large, {}, pose_at({0.002, 0.001, distance_for(800, large)}, 0.2, 0.4), 0, 0.002);
}

TEST_CASE("a marker seen at 75 degrees is found with its id") {
  const CameraModel camera = camera_of(320, 240, 600);
  check_code(camera, {}, pose_at({0.01, 0.01, distance_for(100, camera)}, 75 * kDegree, 1), 1,
             0.005);
}

TEST_CASE("over- and under-exposed markers are found with their id") {
  const CameraModel camera = camera_of(320, 240, 600);
  const Pose truth = pose_at({0.01, 0.01, distance_for(60, camera)}, 0.6, 1);
  // Paper far beyond white; black below what the camera tells.
  check_code(camera, {.black = 120, .white = 420, .floor = 300}, truth, 1, 0.02);
  check_code(camera, {.black = -10, .white = 40, .floor = 20}, truth, 1, 0.02);
}

TEST_CASE("JPEG of quality 50 to 90 costs neither marker nor id") {
  const CameraModel camera = camera_of(320, 240, 600);
  for (const int quality : {50, 70, 90}) {
    for (const double pixels : {30.0, 80.0}) {
      CAPTURE(quality);
      CAPTURE(pixels);
      const Pose truth = pose_at({0.01, 0.01, distance_for(pixels, camera)}, 0.6, 1);
      Painter painter(camera, {});
      painter.add({8, *NecklaceCode(8, 1).word(kId)}, truth);
      painter.blur(1);
      painter.add_noise(2, 5);
      compress(painter.image(), quality);
      check_found(painter, camera, truth, 0.02);
    }
  }
}

TEST_CASE("a plain ring that has print in its margin is no marker, one on clean paper is") {
  const CameraModel camera = camera_of(320, 240, 600);
  const Pose truth = pose_at({0, 0, distance_for(60, camera)}, 0, 0);
  for (const bool printed : {false, true}) {
    CAPTURE(printed);
    Painter painter(camera, {});
    painter.add({.inner_ratio = kPlainInnerRatio}, truth);
    GreyImage& image = painter.image();
    // Two pixels beside the rim: the strokes of a letter, an icon's frame.
    for (int v = 0; printed && v < image.height; ++v) {
      for (int u = 0; u < image.width; ++u) {
        if (u < 160 - 32 || v < 120 - 32) {
          image.pixels[static_cast<std::size_t>(v * image.width + u)] = 40;
        }
      }
    }
    Detector detector({}, camera);
    CHECK(detector.detect(painter.view()).size() == (printed ? 0 : 1));
  }
}
