#include "calibration/board_detector.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "calibration/intrinsic_start.hpp"
#include "core/necklace.hpp"
#include "tests/calibration/board_pictures.hpp"

using namespace roundel;
using namespace roundel::test;

namespace {

// Root mean square distance of the view's points from the true images of the centres.
double error_px(const BoardView& view, const FrameTruth& truth) {
  double squares = 0;
  for (const BoardPoint& point : view.points) {
    const MarkerTruth& marker = truth.markers[static_cast<std::size_t>(point.id) - 1];
    squares += (point.pixel - Eigen::Vector2d(marker.u, marker.v)).squaredNorm();
  }
  return std::sqrt(squares / static_cast<double>(view.points.size()));
}

SceneMarker stray(int id, const Eigen::Vector3d& position) {
  SceneMarker marker;
  marker.bits = 8;
  marker.word = NecklaceCode(8, 1).word(id).value();
  marker.diameter_m = 0.03;
  marker.pose = {position, Eigen::Quaterniond(0, 1, 0, 0)};
  return marker;
}

}  // namespace

TEST_CASE("the centres found are the projected ones, whatever camera was assumed at first") {
  const Board board;
  const CameraModel truth = small_webcam();
  const CameraModel guess = guessed_camera(truth.width, truth.height);
  REQUIRE(guess.fx > 1.1 * truth.fx);  // far off, and without the lens
  BoardCamera camera(board, truth, imaging());
  BoardDetector knowing(board, truth), guessing(board, guess);
  double worst_ellipse = 0;
  for (const Pose& pose : board_poses(board, truth, 8, 4)) {
    const GreyImage picture = camera.take(pose);
    const FrameTruth true_markers = board_truth(board, truth, pose);
    const auto visible = std::count_if(true_markers.markers.begin(), true_markers.markers.end(),
                                       [](const MarkerTruth& m) { return m.visible; });
    const BoardSighting seen = knowing.find(picture.view(), 3);
    CHECK(seen.view.picture == 3);
    CHECK(seen.view.points.size() >= static_cast<std::size_t>(visible));
    CHECK(seen.misplaced == 0);
    CHECK(seen.foreign == 0);
    CHECK(error_px(seen.view, true_markers) < 0.01);
    // A wrong camera moves centres by up to tenths of a pixel: why detection is repeated.
    const BoardSighting guessed = guessing.find(picture.view());
    CHECK(guessed.view.points.size() + 1 >= seen.view.points.size());
    CHECK(error_px(guessed.view, true_markers) < 0.3);
    worst_ellipse = std::max(worst_ellipse, error_px(guessed.view, true_markers));
  }
  CHECK(worst_ellipse > 0.005);
}

TEST_CASE("stated covariances of centres are of the size of their errors") {
  const Board board;
  const CameraModel truth = small_webcam();
  BoardDetector detector(board, truth);
  for (const double noise : {2.0, 8.0}) {
    CAPTURE(noise);
    BoardCamera camera(board, truth, imaging(noise));
    double squares = 0;
    int count = 0;
    for (const Pose& pose : board_poses(board, truth, 8, 5)) {
      const FrameTruth true_markers = board_truth(board, truth, pose);
      for (const BoardPoint& point : detector.find(camera.take(pose).view()).view.points) {
        const MarkerTruth& marker = true_markers.markers[static_cast<std::size_t>(point.id) - 1];
        const Eigen::Vector2d error = point.pixel - Eigen::Vector2d(marker.u, marker.v);
        squares += error.dot(point.covariance.inverse() * error);
        count += 2;
      }
    }
    CHECK(std::sqrt(squares / count) < 1.3);
    CHECK(std::sqrt(squares / count) > 0.9);
  }
}

TEST_CASE("markers that lie elsewhere, wear a wrong id or one worn twice are not taken") {
  const Board board;
  const CameraModel truth = small_webcam();
  BoardCamera camera(board, truth, imaging());
  Scene scene = board_scene(board, {{0, 0, 0.6}, {0, 1, 0, 0}});
  scene.markers.push_back(stray(5, {0.25, 0.1, 0.6}));   // a robot that wears one of the ids
  scene.markers.push_back(stray(30, {0.25, 0.0, 0.6}));  // another, with an id beyond
  const BoardSighting seen = BoardDetector(board, truth).find(camera.take(scene).view());
  CHECK(seen.markers == 29);
  CHECK(seen.foreign == 1);
  CHECK(seen.misplaced == 1);
  CHECK(seen.view.points.size() == 28);
}

TEST_CASE("a board of other columns is no view, and neither are a few markers") {
  const CameraModel truth = small_webcam();
  BoardCamera camera(Board{}, truth, imaging());
  const GreyImage picture = camera.take(Pose{{0, 0, 0.6}, {0, 1, 0, 0}});
  Board other;
  other.columns = 5;
  other.rows = 5;
  const BoardSighting seen = BoardDetector(other, truth).find(picture.view());
  CHECK(seen.markers == 25);
  CHECK(seen.foreign == 3);
  CHECK(2 * seen.misplaced > seen.markers);

  const GreyImage cut = camera.take(Pose{{-0.535, 0, 0.6}, {0, 1, 0, 0}});
  const BoardSighting few = BoardDetector(Board{}, truth).find(cut.view());
  CHECK(few.markers > 0);
  CHECK(few.markers < 6);
  CHECK(few.view.points.empty());
}

TEST_CASE("an empty picture has no board; one of another size is a bug of the caller") {
  GreyImage picture;
  picture.resize(640, 360);
  std::fill(picture.pixels.begin(), picture.pixels.end(), std::uint8_t{128});
  BoardDetector detector(Board{}, small_webcam());
  const BoardSighting seen = detector.find(picture.view());
  CHECK(seen.markers == 0);
  CHECK(seen.view.points.empty());
  CHECK(std::isinf(seen.edge_width_px));
  picture.resize(320, 200);
  CHECK_THROWS_AS(detector.find(picture.view()), std::invalid_argument);
}

TEST_CASE("edges are as wide as blur and motion make them") {
  const Board board;
  const CameraModel truth = small_webcam();
  BoardDetector detector(board, truth);
  const Pose pose{{0, 0, 0.5}, {0, 1, 0, 0}};
  const auto width = [&](const Imaging& how, const Eigen::Vector3d& velocity) {
    BoardCamera camera(board, truth, how);
    Scene scene = board_scene(board, pose);
    for (SceneMarker& marker : scene.markers) marker.velocity = velocity;
    return detector.find(camera.take(scene).view()).edge_width_px;
  };
  const double sharp = width(imaging(2, 0.3), {0, 0, 0});
  const double soft = width(imaging(2, 1.5), {0, 0, 0});
  CHECK(sharp > 0.7);
  CHECK(sharp < 2.4);
  // Between the quarters of a Gaussian edge of 1.5 px and a pixel's own width: 2.7 times 1.53.
  CHECK(soft == doctest::Approx(4.1).epsilon(0.15));
  Imaging moving = imaging(2, 0.3);
  moving.exposure_s = 0.02;
  // 0.25 m/s in 20 ms at 0.5 m: 4.8 px, in one direction only.
  CHECK(width(moving, {0.25, 0, 0}) == doctest::Approx(4.8).epsilon(0.25));
  CHECK(width(moving, {0, 0.25, 0}) == doctest::Approx(4.8).epsilon(0.25));
}
