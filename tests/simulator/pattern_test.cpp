#include <doctest/doctest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "simulator/renderer.hpp"
#include "tests/simulator/reference.hpp"

using namespace roundel;

namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

// Squarely in front of a camera without lens errors, 800 pixels wide.
struct Large {
  CameraModel camera = reference::pinhole(1100, 1100, 1000);
  double radius_px = 400;
  SceneMarker marker;
  GreyImage image;

  explicit Large(MarkerKind kind) {
    marker.kind = kind;
    marker.pose.orientation = reference::facing();
    marker.pose.position = {0, 0, camera.fx * marker.diameter_m / (2 * radius_px)};
  }
  void render() {
    Imaging imaging;
    imaging.black = 0;
    imaging.white = 200;
    Renderer(camera, imaging).render({{}, {marker}, {}}, 0, image);
  }
  // Grey between pixels, at a place in the picture.
  double at(double u, double v) const {
    const int i = static_cast<int>(std::floor(u)), j = static_cast<int>(std::floor(v));
    const double s = u - i, t = v - j;
    const auto& view = image.view();
    return (1 - t) * ((1 - s) * view.at(i, j) + s * view.at(i + 1, j)) +
           t * ((1 - s) * view.at(i, j + 1) + s * view.at(i + 1, j + 1));
  }
  // At a radius (of the black disc's) and an angle, counter-clockwise from 3 o'clock.
  double at_polar(double rho, double degrees) const {
    const double r = rho * radius_px;
    return at(camera.cx + r * std::cos(degrees / kDegrees),
              camera.cy - r * std::sin(degrees / kDegrees));
  }
};

struct Edge {
  double place;
  bool to_white;
};

// Where a function of a place crosses the grey half way between black and white.
template <typename Sample>
std::vector<Edge> edges(double from, double to, double step, const Sample& grey) {
  std::vector<Edge> found;
  const int steps = static_cast<int>(std::ceil((to - from) / step));
  double before = grey(from) - 100;
  for (int k = 0; k < steps; ++k) {
    const double after = grey(from + (k + 1) * step) - 100;
    if ((before < 0) != (after < 0)) {
      found.push_back({from + step * (k + before / (before - after)), after >= 0});
    }
    before = after;
  }
  return found;
}

}  // namespace

TEST_CASE("the teeth's edges lie at their angles, counter-clockwise from 3 o'clock") {
  // 0b00101101: black-white for 0, white-black for 1; an edge in every bit, and between equal bits.
  struct Case {
    int bits;
    std::uint32_t word;
    std::vector<int> edges;  // in half-bits; the first is at 3 o'clock or after
  };
  const Case cases[] = {
      {8, 0b00101101, {0, 1, 2, 3, 5, 7, 9, 10, 11, 13, 15}},
      {3, 0b001, {1, 2, 3, 5}},
      {7, 0b0000001, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 13}},
  };
  for (const Case& c : cases) {
    CAPTURE(c.bits);
    Large large(MarkerKind::WhyCode);
    large.marker.bits = c.bits;
    large.marker.word = c.word;
    large.render();
    const double half = 180.0 / c.bits;
    for (const double rho : {0.40, 0.47, 0.55}) {
      const auto found =
          edges(-0.3, 359.7, 0.05, [&](double degrees) { return large.at_polar(rho, degrees); });
      std::vector<double> expected;
      std::vector<bool> rises;
      for (int k = 0; k < 2 * c.bits; ++k) {
        // A half-bit is white if it is the first of a 1 or the second of a 0.
        const auto white = [&](int h) {
          const int bit = h / 2;
          return ((c.word >> (c.bits - 1 - bit)) & 1U) == (h % 2 == 0 ? 1U : 0U);
        };
        const int before = (k + 2 * c.bits - 1) % (2 * c.bits);
        if (white(k) == white(before)) continue;
        expected.push_back(k * half);
        rises.push_back(white(k));
      }
      REQUIRE(found.size() == expected.size());
      for (std::size_t k = 0; k < found.size(); ++k) {
        CHECK(std::abs(found[k].place - expected[k]) < 0.03);  // 0.1 pixel here
        CHECK(found[k].to_white == rises[k]);
      }
    }
  }
}

TEST_CASE("a 1 is white first, a 0 black first, and the first bit starts at 3 o'clock") {
  Large large(MarkerKind::WhyCode);
  large.marker.bits = 4;
  large.marker.word = 0b0011;  // 0 0 1 1 counter-clockwise: upper half zeros, lower half ones
  large.render();
  const int halves[] = {0, 200, 0, 200, 200, 0, 200, 0};
  for (int k = 0; k < 8; ++k) CHECK(large.at_polar(0.47, 22.5 + 45 * k) == halves[k]);
}

TEST_CASE("the rims have the printed radii") {
  const auto rims = [](const Large& large, double degrees) {
    std::vector<double> radii;
    for (const Edge& e :
         edges(0.01, 1.32, 0.0005, [&](double rho) { return large.at_polar(rho, degrees); })) {
      radii.push_back(e.place);
    }
    return radii;
  };
  const double tolerance = 0.1 / 400;

  Large plain(MarkerKind::WhyCon);
  for (const double ratio : {50.0 / 122.0, 0.33, 0.6}) {
    plain.marker.inner_ratio = ratio;
    plain.render();
    for (const double degrees : {0.0, 37.0, 90.0, 250.0}) {
      const auto found = rims(plain, degrees);
      REQUIRE(found.size() == 2);
      CHECK(std::abs(found[0] - ratio) < tolerance);
      CHECK(std::abs(found[1] - 1) < tolerance);
    }
  }

  Large code(MarkerKind::WhyCode);
  code.marker.bits = 4;
  code.marker.word = 0b0011;
  code.render();
  const auto through_white = rims(code, 67.5);
  REQUIRE(through_white.size() == 2);
  CHECK(std::abs(through_white[0] - 420.0 / 700) < tolerance);
  CHECK(std::abs(through_white[1] - 1) < tolerance);
  const auto through_black = rims(code, 22.5);
  REQUIRE(through_black.size() == 2);
  CHECK(std::abs(through_black[0] - 240.0 / 700) < tolerance);

  Large disc(MarkerKind::Disc);
  disc.render();
  CHECK(rims(disc, 200).size() == 1);
}

TEST_CASE("the white plate reaches as far as it should, and the floor lies around it") {
  Large large(MarkerKind::Disc);
  large.marker.plate_ratio = 1.25;
  large.render();
  CHECK(large.at_polar(1.2, 10) == 200);
  CHECK(large.at_polar(1.3, 10) == 120);
  CHECK(large.image.view().at(0, 0) == 120);
}

TEST_CASE("the areas of black and white are those of the pattern") {
  Large large(MarkerKind::WhyCode);
  large.marker.bits = 8;
  large.marker.word = 0b01010011;
  large.marker.plate_ratio = 1.3;
  large.render();
  double dark = 0;
  for (int v = 0; v < 1100; ++v) {
    for (int u = 0; u < 1100; ++u) {
      const double rho = std::hypot(u - large.camera.cx, v - large.camera.cy) / 400;
      if (rho < 1.1) dark += (200.0 - large.image.view().at(u, v)) / 200;
    }
  }
  // Half of the code ring is white, whatever the word.
  const double outer = 0.6 * 0.6, inner = (240.0 / 700) * (240.0 / 700);
  const double expected = std::numbers::pi * 400 * 400 * (1 - inner - 0.5 * (outer - inner));
  CHECK(dark == doctest::Approx(expected).epsilon(2e-5));
}

TEST_CASE("a marker seen from behind is not drawn, a shape is") {
  const CameraModel camera = reference::pinhole(200, 200, 500);
  Imaging imaging;
  SceneMarker marker;
  marker.pose.position = {0, 0, 0.5};
  marker.pose.orientation = Eigen::Quaterniond::Identity();  // z away from the camera
  GreyImage image;
  Renderer(camera, imaging).render({{}, {marker}, {}}, 0, image);
  CHECK(image.pixels == std::vector<std::uint8_t>(200 * 200, 120));

  for (const Eigen::Quaterniond& side : {Eigen::Quaterniond::Identity(), reference::facing()}) {
    SceneShape shape;
    shape.pose = {{0, 0, 0.5}, side};
    shape.hole_ratio = 0.5;
    Renderer(camera, imaging).render({{shape}, {}, {}}, 0, image);
    CHECK(image.view().at(100, 100) == 215);
    CHECK(image.view().at(135, 100) == 35);
    CHECK(image.view().at(100, 160) == 120);
  }
}

TEST_CASE("shapes are painted in the order clutter, markers, occluders") {
  const CameraModel camera = reference::pinhole(200, 200, 500);
  SceneMarker marker;
  marker.kind = MarkerKind::Disc;
  marker.pose = {{0, 0, 0.5}, reference::facing()};
  SceneShape below, above;
  below.pose = above.pose = marker.pose;
  below.outline = above.outline = Outline::Rectangle;
  below.width_m = below.height_m = 0.19;
  below.grey = 10;
  above.width_m = above.height_m = 0.01;
  above.grey = 99;
  GreyImage image;
  Renderer(camera, {}).render({{below}, {marker}, {above}}, 0, image);
  CHECK(image.view().at(100, 100) == 99);
  CHECK(image.view().at(120, 100) == 35);
  CHECK(image.view().at(168, 100) == 215);
  CHECK(image.view().at(190, 100) == 10);
}

TEST_CASE("what cannot exist is refused with its value") {
  const CameraModel camera = reference::pinhole(100, 100, 100);
  Renderer renderer(camera, {});
  GreyImage image;
  const auto refused = [&](auto change) {
    SceneMarker marker;
    marker.pose = {{0, 0, 1}, reference::facing()};
    change(marker);
    CHECK_THROWS_AS(renderer.render({{}, {marker}, {}}, 0, image), std::invalid_argument);
  };
  refused([](SceneMarker& m) { m.diameter_m = 0; });
  refused([](SceneMarker& m) { m.diameter_m = std::nan(""); });
  refused([](SceneMarker& m) { m.plate_ratio = 0.9; });
  refused([](SceneMarker& m) { m.bits = 17; });
  refused([](SceneMarker& m) { m.bits = 1; });
  refused([](SceneMarker& m) { m.word = 256; });
  refused([](SceneMarker& m) {
    m.kind = MarkerKind::WhyCon;
    m.inner_ratio = 1;
  });
  CHECK_THROWS_AS(Renderer(camera, {.blur_px = 11}), std::invalid_argument);
  CHECK_THROWS_AS(Renderer(camera, {.noise_sigma = -1}), std::invalid_argument);
  CHECK_THROWS_AS(Renderer(camera, {.gamma = 0}), std::invalid_argument);
  CHECK_THROWS_AS(Renderer(camera, {.gradient = 2}), std::invalid_argument);
  CHECK_THROWS_AS(Renderer(camera, {.shadow_factor = 1.5}), std::invalid_argument);
  CHECK_THROWS_AS(Renderer(camera, {.white = 256}), std::invalid_argument);
  CHECK_THROWS_AS(Renderer(CameraModel{}, {}), std::invalid_argument);
}

TEST_CASE("things behind the camera or far outside of the picture do no harm") {
  Renderer renderer(reference::webcam(), {});
  GreyImage image;
  Scene scene;
  for (const Eigen::Vector3d& place :
       {Eigen::Vector3d(0, 0, -1), Eigen::Vector3d(0, 0, 0.01), Eigen::Vector3d(500, 0, 1),
        Eigen::Vector3d(3, -2, 1), Eigen::Vector3d(0, 0, 1e6)}) {
    SceneMarker marker;
    marker.pose = {place, reference::facing()};
    scene.markers.push_back(marker);
  }
  renderer.render(scene, 0, image);
  // The far one is a hundred thousandth of a pixel; all else is floor.
  CHECK(image.pixels == std::vector<std::uint8_t>(image.pixels.size(), 120));
}
