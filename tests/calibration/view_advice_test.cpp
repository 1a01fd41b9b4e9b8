#include "calibration/view_advice.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <numbers>
#include <string>

#include "calibration/picture_coverage.hpp"
#include "tests/calibration/synthetic_views.hpp"

using namespace roundel;
using test::SyntheticViews;

namespace {

bool mentions(const std::vector<std::string>& advice, const std::string& words) {
  return std::any_of(advice.begin(), advice.end(), [&](const std::string& line) {
    return line.find(words) != std::string::npos;
  });
}

}  // namespace

TEST_CASE("varied views leave nothing to be wished for") {
  SyntheticViews source(Board{}, test::webcam(), 1);
  const auto advice = view_advice(source.varied_views(20, 0), source.camera);
  for (const std::string& line : advice) MESSAGE(line);
  CHECK(advice.empty());
}

TEST_CASE("advice names the parts of the picture, the sides and the number that are missing") {
  SyntheticViews source(Board{}, test::webcam(), 2);
  // Facing right and down in the picture: its left and its top are nearer.
  const std::vector<BoardView> views = {
      source.view(0, source.pose({500, 300}, 0.5, -0.25 * std::numbers::pi, 0, 0.2), 0)};
  const auto normal = source.pose({500, 300}, 0.5, -0.25 * std::numbers::pi, 0, 0.2).normal();
  CAPTURE(normal.transpose());
  const auto advice = view_advice(views, source.camera);
  CHECK(mentions(advice, "lower right"));
  CHECK_FALSE(mentions(advice, "upper left"));
  CHECK(mentions(advice, "turn it by 90 degrees"));
  CHECK(mentions(advice, "bring it closer"));
  CHECK(mentions(advice, "14 more views: 1 of 15"));
  CHECK(mentions(advice, normal.x() > 0 ? "right" : "left"));
}

TEST_CASE("a side counts as nearer if the board's markers there are larger in the picture") {
  SyntheticViews source(Board{}, test::webcam(), 3);
  constexpr double kQuarter = std::numbers::pi / 2;
  for (int i = 0; i < 4; ++i) {
    const Pose pose = source.pose({960, 540}, 0.5, i * kQuarter, 0, 0.5);
    // Depths of the middles of the four sides, by where they are in the picture.
    const double left = pose.to_camera({-0.12, 0, 0}).z(), right = pose.to_camera({0.12, 0, 0}).z();
    const double top = pose.to_camera({0, 0.06, 0}).z(), bottom = pose.to_camera({0, -0.06, 0}).z();
    const auto advice = view_advice(std::vector{source.view(0, pose, 0)}, source.camera);
    const std::string nearer = left < right - 0.05   ? "left"
                               : right < left - 0.05 ? "right"
                               : top < bottom - 0.03 ? "top"
                                                     : "bottom";
    std::string sides;
    for (const std::string& line : advice) {
      if (line.starts_with("tilt it")) sides = line.substr(line.rfind(':'));
    }
    CAPTURE(nearer);
    CAPTURE(sides);
    for (const char* side : {"left", "right", "top", "bottom"})
      CHECK((sides.find(side) == std::string::npos) == (nearer == side));
  }
}

TEST_CASE("regions of the picture are covered by the markers in them") {
  PictureCoverage coverage(1000, 500);
  CHECK(coverage.covered() == 0);
  CHECK(coverage.missing().size() == PictureCoverage::kRegions);
  BoardView view;
  for (const Eigen::Vector2d& pixel : {Eigen::Vector2d(0, 0), Eigen::Vector2d(500, 250),
                                       Eigen::Vector2d(999, 250), Eigen::Vector2d(219, 109)}) {
    BoardPoint point;
    point.pixel = pixel;
    view.points.push_back(point);
  }
  coverage.add(view);
  CHECK(coverage.covered() == 3);
  CHECK(coverage.missing() == std::vector<std::string>{"top", "upper right", "left", "lower left",
                                                       "bottom", "lower right"});
}

TEST_CASE("lists of words read as sentences") {
  CHECK(listed({}) == "");
  CHECK(listed(std::vector<std::string>{"a"}) == "a");
  CHECK(listed(std::vector<std::string>{"a", "b"}) == "a and b");
  CHECK(listed(std::vector<std::string>{"a", "b", "c"}) == "a, b and c");
}
