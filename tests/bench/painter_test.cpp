#include "bench/common/painter.hpp"

#include <doctest/doctest.h>

#include "core/necklace.hpp"
#include "simulator/renderer.hpp"
#include "tests/bench/scene.hpp"

using namespace roundel;
using namespace roundel::bench;

namespace {

GreyImage painted(const Experiment& experiment, Print print) {
  GreyImage image;
  Painter(experiment, std::move(print)).paint(experiment.views.front(), image);
  return image;
}

}  // namespace

TEST_CASE("circular prints make the simulator's pictures, to the last pixel") {
  Experiment experiment = one_marker(3);
  experiment.clutter.push_back(
      {.width_m = 0.2, .pose = {{-0.3, 0.2, 2.5}, Eigen::Quaterniond(0, 1, 0, 0)}});
  SceneMarker marker;
  marker.word = NecklaceCode(8, 1).word(4).value();
  marker.diameter_m = experiment.diameter_m;
  marker.plate_ratio = experiment.plate_ratio;
  marker.pose = experiment.views.front().markers.front().pose;

  GreyImage expected;
  SUBCASE("WhyCode") {
    Renderer(experiment.camera, experiment.imaging)
        .render({experiment.clutter, {marker}, {}}, 77, expected);
    CHECK(painted(experiment, whycode_print(experiment)).pixels == expected.pixels);
  }
  SUBCASE("WhyCon") {
    marker.kind = MarkerKind::WhyCon;
    Renderer(experiment.camera, experiment.imaging)
        .render({experiment.clutter, {marker}, {}}, 77, expected);
    CHECK(painted(experiment, whycon_print(experiment)).pixels == expected.pixels);
  }
}

TEST_CASE("a square tag's cells appear where the page has them") {
  Experiment experiment = one_marker();
  PlacedMarker& marker = experiment.views.front().markers.front();
  marker.number = 0;
  marker.pose.position = {0, 0, 2};
  marker.pose.orientation = facing_camera();
  // 60 px: three cells of 20 px, the top right one white.
  const SquarePattern pattern{3, {false, false, true, false, false, false, false, false, false}};
  const GreyImage image = painted(experiment, square_print(experiment, {pattern}));
  const auto at = [&](int u, int v) { return static_cast<int>(image.view().at(u, v)); };
  CHECK(at(159 + 20, 119 - 20) == 200);
  CHECK(at(159, 119) == 30);
  CHECK(at(159 - 20, 119 - 20) == 30);
  CHECK(at(159 + 20, 119 + 20) == 30);
  CHECK(at(159 + 35, 119) == 200);  // the plate's margin, 30 to 40.5 px from the middle
  CHECK(at(159 + 45, 119) == 110);
}

TEST_CASE("a square tag covers the area that its size and distance say") {
  Experiment experiment = one_marker();
  PlacedMarker& marker = experiment.views.front().markers.front();
  marker.number = 0;
  marker.pose.orientation = tilted(0, 0, 0.3);
  const SquarePattern black{1, {false}}, white{1, {true}};
  const GreyImage dark = painted(experiment, square_print(experiment, {black}));
  const GreyImage bright = painted(experiment, square_print(experiment, {white}));
  double sum = 0;
  for (std::size_t i = 0; i < dark.pixels.size(); ++i) sum += bright.pixels[i] - dark.pixels[i];
  CHECK(sum / (200 - 30) == doctest::Approx(60 * 60).epsilon(0.002));
}

TEST_CASE("white cells side by side have no seam") {
  Experiment experiment = one_marker();
  experiment.views.front().markers.front().number = 0;
  const SquarePattern cells{4, std::vector<bool>(16, true)}, whole{1, {true}};
  CHECK(painted(experiment, square_print(experiment, {cells})).pixels ==
        painted(experiment, square_print(experiment, {whole})).pixels);
}
