#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "core/grey_image.hpp"
#include "simulator/coverage.hpp"
#include "simulator/random.hpp"
#include "simulator/renderer.hpp"
#include "tests/simulator/reference.hpp"

using namespace roundel;
using reference::Vector2d;

namespace {

// Black on white everywhere, so that the picture's darkness is the disc's coverage.
Imaging ink_on_paper() {
  Imaging imaging;
  imaging.black = 0;
  imaging.white = imaging.floor = 255;
  return imaging;
}

struct View {
  const char* name;
  double diameter_px, tilt, direction;  // across the middle of the image, radians
  double x, y;                          // normalised place
};

}  // namespace

TEST_CASE("a projected disc has the centroid and the area of the analytic outline") {
  constexpr double kDiameter = 0.122;
  const View views[] = {
      {"small and frontal", 14, 0, 0, 0.0003, 0.0001},
      {"small and tilted", 20, 1.0, 0.4, 0.31, -0.12},
      {"small in the corner", 14, 0.5, -1.1, -0.55, 0.31},
      {"usual", 59, 0.03, 1.1, 0.2, 0.2},
      {"usual, steep", 59, 1.2, -1.24, -0.4, -0.25},
      {"usual in the corner", 59, 0.6, 0.7, 0.58, 0.33},
      {"large", 300, 0.8, -0.6, -0.1, 0.05},
      {"huge", 800, 0.4, 0.3, 0.02, -0.03},
      {"huge and tilted", 800, 0.9, -1.2, 0.1, 0.0},
  };
  for (const bool lens : {false, true}) {
    CameraModel camera = reference::webcam();
    if (!lens) camera.distortion = {};
    Renderer renderer(camera, ink_on_paper());
    for (const View& view : views) {
      CAPTURE(std::string(view.name));
      CAPTURE(lens);
      SceneMarker disc;
      disc.kind = MarkerKind::Disc;
      disc.diameter_m = kDiameter;
      const double depth = camera.fx * kDiameter / view.diameter_px;
      disc.pose.position = {view.x * depth, view.y * depth, depth};
      disc.pose.orientation = reference::turned(view.tilt, view.direction, 0.3);
      REQUIRE(disc.pose.normal().dot(disc.pose.position) < 0);
      GreyImage image;
      renderer.render({{}, {disc}, {}}, 0, image);

      const auto seen = reference::darkness(image, 0, 255);
      const auto truth = reference::disc_image(camera, disc.pose, kDiameter / 2);
      CHECK((seen.centroid - truth.centroid).norm() < 0.003);
      // As an error of the radius, in pixels.
      const double radius = std::sqrt(truth.area / std::numbers::pi);
      CHECK(std::abs(std::sqrt(seen.area / std::numbers::pi) - radius) < 0.0015);
    }
  }
}

TEST_CASE("every pixel of a picture is the mean over its area, for all kinds of marker") {
  const CameraModel camera = reference::webcam();
  const Imaging imaging;
  Renderer renderer(camera, imaging);
  Random random(7);
  int checked = 0;
  for (int i = 0; i < 9; ++i) {
    SceneMarker marker;
    marker.kind = i % 3 == 0   ? MarkerKind::Disc
                  : i % 3 == 1 ? MarkerKind::WhyCon
                               : MarkerKind::WhyCode;
    marker.inner_ratio = random.uniform(0.33, 0.6);
    marker.bits = 5 + i;
    marker.word = random.below(1U << marker.bits);
    marker.plate_ratio = random.uniform(1.0, 1.4);
    const double depth = random.uniform(2.0, 6.0);
    marker.pose.position = {random.uniform(-0.5, 0.5) * depth, random.uniform(-0.25, 0.25) * depth,
                            depth};
    marker.pose.orientation =
        reference::turned(random.uniform(0, 1.1), random.uniform(0, 6.2), random.uniform(0, 6.2));
    if (marker.pose.normal().dot(marker.pose.position) > 0) continue;
    GreyImage image;
    renderer.render({{}, {marker}, {}}, 0, image);

    const Vector2d middle = reference::project(camera, marker.pose.position);
    const int reach = static_cast<int>(0.7 * marker.diameter_m * camera.fx / depth) + 3;
    const int u0 = static_cast<int>(middle.x()), v0 = static_cast<int>(middle.y());
    double worst = 0, sum = 0;
    for (int v = v0 - reach; v <= v0 + reach; ++v) {
      for (int u = u0 - reach; u <= u0 + reach; ++u) {
        const double expected = reference::pixel_of(marker, imaging, camera, u, v, 24);
        const double error = image.view().at(u, v) - expected;
        worst = std::max(worst, std::abs(error));
        sum += error;
        ++checked;
      }
    }
    CAPTURE(i);
    // Half a grey level of rounding and what 24 x 24 points miss at an edge.
    CHECK(worst < 5.0);
    CHECK(std::abs(sum) / ((2 * reach + 1) * (2 * reach + 1)) < 0.03);
  }
  CHECK(checked > 10000);
}

TEST_CASE("a polygon's coverage is exact, also where the grid cuts it") {
  CoverageGrid grid;
  grid.reset(8, 6);
  const auto add = [&](double weight, const std::vector<Vector2d>& points) {
    grid.begin(weight);
    for (const Vector2d& p : points) grid.add(p);
    grid.end();
  };
  const auto total = [&] {
    double sum = 0;
    for (int j = 0; j < grid.height(); ++j) {
      double covered = 0;
      for (int i = 0; i < grid.width(); ++i) {
        covered += static_cast<double>(grid.row(j)[i]);
        sum += covered;
      }
    }
    return sum;
  };
  const auto at = [&](int i, int j) {
    double covered = 0;
    for (int k = 0; k <= i; ++k) covered += static_cast<double>(grid.row(j)[k]);
    return covered;
  };

  SUBCASE("a rectangle between cells") {
    add(1, {{1.25, 1.5}, {3.5, 1.5}, {3.5, 3.75}, {1.25, 3.75}});  // clockwise on the screen
    CHECK(at(1, 1) == doctest::Approx(0.75 * 0.5));
    CHECK(at(2, 2) == doctest::Approx(1));
    CHECK(at(3, 3) == doctest::Approx(0.5 * 0.75));
    CHECK(at(5, 2) == doctest::Approx(0).epsilon(1e-6));
    CHECK(total() == doctest::Approx(2.25 * 2.25));
  }
  SUBCASE("the other sense subtracts") {
    add(2, {{1, 1}, {1, 4}, {5, 4}, {5, 1}});
    CHECK(at(2, 2) == doctest::Approx(-2));
  }
  SUBCASE("a flat triangle that crosses many cells of a row") {
    add(1, {{0.5, 2.25}, {7.5, 2.25}, {7.5, 2.75}});
    CHECK(total() == doctest::Approx(0.5 * 7 * 0.5));
    CHECK(at(4, 2) == doctest::Approx(0.5 * (4.5 - 0.5) / 7));  // the mean height over the cell
  }
  SUBCASE("a polygon larger than the grid covers all of it") {
    add(1, {{-5, -7}, {20, -6}, {19, 15}, {-8, 14}});
    CHECK(at(0, 0) == doctest::Approx(1));
    CHECK(at(7, 5) == doctest::Approx(1));
    CHECK(total() == doctest::Approx(48));
  }
  SUBCASE("parts outside count for nothing") {
    add(1, {{-3, 1}, {2, 1}, {2, 3}, {-3, 3}});
    add(1, {{6, 4}, {30, 4}, {30, 40}, {6, 40}});
    add(1, {{1, -9}, {3, -9}, {3, -2}, {1, -2}});
    CHECK(total() == doctest::Approx(4 + 4));
  }
  SUBCASE("a slanted edge through the border") {
    add(1, {{-4, 0}, {4, 0}, {-4, 6}});  // leaves the grid on the left; hypotenuse y = 3 - 3x/4
    CHECK(total() == doctest::Approx(0.5 * 4 * 3));
  }
}
