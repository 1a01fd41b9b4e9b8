#include "daemon/draw_markers.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>

#include "core/grey_image.hpp"
#include "daemon/cairo_pointer.hpp"
#include "tests/temporary_directory.hpp"

namespace roundel {
namespace {

constexpr int kWidth = 320, kHeight = 240;

CameraModel test_camera() {
  CameraModel camera;
  camera.width = kWidth;
  camera.height = kHeight;
  camera.fx = camera.fy = 400;
  camera.cx = 160;
  camera.cy = 120;
  return camera;
}

// Seen squarely from 1 m, upright: x to the image's right, y up.
Marker upright_marker() {
  Marker marker;
  marker.id = 7;
  marker.u = 160;
  marker.v = 120;
  marker.ellipse = {160, 120, 40, 40, 0};
  marker.has_pose = true;
  marker.pose.position = {0, 0, 1};
  marker.pose.orientation = Eigen::Quaterniond(0, 1, 0, 0);
  return marker;
}

struct Colour {
  int red, green, blue;
};

class Drawn {
 public:
  Drawn(const Marker& marker, const std::optional<CameraModel>& camera) {
    const TemporaryDirectory directory;
    GreyImage frame;
    frame.resize(kWidth, kHeight);
    std::fill(frame.pixels.begin(), frame.pixels.end(), std::uint8_t{100});
    const std::array markers = {marker};
    save_annotated_png(directory.file("a.png"), frame.view(), markers, camera, 0.2);
    surface_.reset(cairo_image_surface_create_from_png(directory.file("a.png").c_str()));
    REQUIRE(cairo_image_surface_get_width(surface_.get()) == kWidth);
    REQUIRE(cairo_image_surface_get_height(surface_.get()) == kHeight);
  }

  Colour at(double u, double v) const {
    const auto* data = cairo_image_surface_get_data(surface_.get());
    const std::ptrdiff_t stride = cairo_image_surface_get_stride(surface_.get());
    const auto* pixel = data + std::lround(v) * stride + std::lround(u) * 4;
    return {pixel[2], pixel[1], pixel[0]};  // little-endian 0xRRGGBB
  }

 private:
  CairoSurface surface_;
};

bool is_untouched(Colour c) {
  return c.red == 100 && c.green == 100 && c.blue == 100;
}
bool is_outline(Colour c) {
  return c.red > 180 && c.green > 120 && c.blue < 60;
}
bool is_red(Colour c) {
  return c.red > 180 && c.green < 90 && c.blue < 90;
}
bool is_green(Colour c) {
  return c.green > 150 && c.red < 90 && c.blue < 90;
}

}  // namespace

TEST_CASE("the outline is drawn on the ellipse, as wide along it as across") {
  Marker marker = upright_marker();
  marker.ellipse = {150, 130, 60, 25, 0.5};
  const Drawn drawn(marker, std::nullopt);
  for (int i = 0; i < 24; ++i) {
    const double t = i * std::numbers::pi / 12;
    const auto on = [&](double scale) {
      const double x = scale * 60 * std::cos(t);
      const double y = scale * 25 * std::sin(t);
      return drawn.at(150 + x * std::cos(0.5) - y * std::sin(0.5),
                      130 + x * std::sin(0.5) + y * std::cos(0.5));
    };
    CAPTURE(i);
    CHECK(is_outline(on(1)));
    CHECK(is_untouched(on(0.7)));
  }
  CHECK(is_untouched(drawn.at(150, 130)));  // no axes without a camera
}

TEST_CASE("the x axis is drawn red and the y axis green, as long as the radius") {
  const Drawn drawn(upright_marker(), test_camera());
  // A radius of 0.1 m at 1 m is 40 pixels.
  CHECK(is_red(drawn.at(160 + 30, 120)));
  CHECK(is_green(drawn.at(160, 120 - 30)));
  CHECK(is_untouched(drawn.at(160 - 30, 120)));
  CHECK(is_untouched(drawn.at(160, 120 + 30)));
  CHECK(is_untouched(drawn.at(160 + 52, 120)));
}

TEST_CASE("a marker at the image's border or with a pose that does not project is still drawn") {
  Marker marker = upright_marker();
  marker.ellipse = {2, 2, 40, 30, 0};
  marker.pose.position = {0, 0, -1};
  CHECK(is_outline(Drawn(marker, test_camera()).at(42, 2)));
}

}  // namespace roundel
