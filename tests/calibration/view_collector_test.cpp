#include "calibration/view_collector.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <string>

#include "calibration/picture_calibration.hpp"
#include "tests/calibration/board_pictures.hpp"

using namespace roundel;
using namespace roundel::test;
using Outcome = ViewCollector::Outcome;

namespace {

Pose frontal(double x, double y, double z) {
  return {{x, y, z}, {0, 1, 0, 0}};
}

struct Stream {
  Stream() : camera(Board{}, small_webcam(), imaging()), collector(Board{}, 640, 360) {}
  Outcome offer(const Pose& pose) { return collector.offer(camera.take(pose).view(), "frame"); }

  BoardCamera camera;
  ViewCollector collector;
};

}  // namespace

TEST_CASE("a still board is taken once, and again when it is elsewhere") {
  Stream stream;
  CHECK(stream.offer(frontal(0, 0, 0.6)) == Outcome::kTaken);
  // The first frame can't tell motion; the second can, and is the better one.
  CHECK(stream.offer(frontal(0, 0, 0.6)) == Outcome::kReplaced);
  CHECK(stream.offer(frontal(0, 0, 0.6)) == Outcome::kAlike);
  CHECK(stream.offer(frontal(0.15, 0, 0.6)) == Outcome::kTaken);
  CHECK(stream.offer(frontal(0.15, 0, 0.6)) == Outcome::kReplaced);
  CHECK(stream.collector.views().size() == 2);
  CHECK(stream.collector.views()[1].picture.width == 640);
}

TEST_CASE("a tilt, a turn or another distance at the same place is another view") {
  Stream stream;
  stream.offer(frontal(0, 0, 0.6));
  Pose tilted = frontal(0, 0, 0.6);
  tilted.orientation = with_positive_w(
      Eigen::Quaterniond(Eigen::AngleAxisd(0.9, Eigen::Vector3d::UnitY())) * tilted.orientation);
  Pose turned = frontal(0, 0, 0.6);
  turned.orientation = with_positive_w(
      turned.orientation * Eigen::Quaterniond(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ())));
  for (const Pose& pose : {frontal(0, 0, 0.95), tilted, turned}) {
    stream.offer(pose);  // it may seem to move there
    const Outcome outcome = stream.offer(pose);
    CAPTURE(std::string(describe(outcome)));
    CAPTURE(pose.orientation.coeffs().transpose());
    CHECK((outcome == Outcome::kTaken || outcome == Outcome::kReplaced));
  }
  CHECK(stream.collector.views().size() == 4);
}

TEST_CASE("while the board moves nothing is taken") {
  Stream stream;
  stream.offer(frontal(0, 0, 0.6));
  for (int i = 1; i <= 8; ++i) CHECK(stream.offer(frontal(0.015 * i, 0, 0.6)) == Outcome::kMoving);
  CHECK(stream.collector.views().size() == 1);
  CHECK(stream.offer(frontal(0.12, 0, 0.6)) == Outcome::kTaken);  // it has stopped
}

TEST_CASE("a blurred picture is not taken, and one without the board neither") {
  Stream stream;
  BoardCamera soft(Board{}, small_webcam(), imaging(2, 2.9));
  CHECK(stream.collector.offer(soft.take(frontal(0, 0, 0.22)).view(), "soft") == Outcome::kBlurred);
  CHECK(stream.offer(frontal(5, 0, 0.6)) == Outcome::kNoBoard);
  CHECK(stream.collector.views().empty());
  CHECK(stream.collector.tally().pictures == 2);
  CHECK(stream.collector.tally().views == 1);
}

TEST_CASE("a sharper picture takes the place of one that it resembles") {
  Stream stream;
  BoardCamera soft(Board{}, small_webcam(), imaging(2, 1.2));
  const Pose pose = frontal(0.02, 0.01, 0.5);
  stream.collector.offer(soft.take(pose).view(), "soft");
  stream.collector.offer(soft.take(pose).view(), "soft");
  CHECK(stream.offer(pose) == Outcome::kReplaced);
  CHECK(stream.collector.views()[0].name == "frame");
}

TEST_CASE("a picture that somebody chose is taken, whatever it is like") {
  Stream stream;
  const GreyImage picture = stream.camera.take(frontal(0, 0, 0.6));
  CHECK(stream.collector.take(picture.view(), "a") == Outcome::kTaken);
  CHECK(stream.collector.take(picture.view(), "b") == Outcome::kTaken);
  GreyImage empty;
  empty.resize(640, 360);
  CHECK(stream.collector.take(empty.view(), "c") == Outcome::kNoBoard);
  CHECK(stream.collector.views().size() == 2);
  CHECK(stream.collector.views()[1].name == "b");
}

TEST_CASE("there is an end to what is kept") {
  Stream stream;
  const GreyImage picture = stream.camera.take(frontal(0, 0, 0.6));
  for (std::size_t i = 0; i < ViewCollector::kMaxPictures; ++i)
    CHECK(stream.collector.take(picture.view(), "a") == Outcome::kTaken);
  CHECK(stream.collector.take(picture.view(), "a") == Outcome::kFull);
  CHECK(stream.offer(frontal(0.15, 0, 0.6)) == Outcome::kFull);
}

TEST_CASE("every outcome has words") {
  for (const Outcome outcome :
       {Outcome::kTaken, Outcome::kReplaced, Outcome::kNoBoard, Outcome::kMoving, Outcome::kBlurred,
        Outcome::kAlike, Outcome::kFull}) {
    CHECK(std::string(describe(outcome)) != "");
  }
}

TEST_CASE("out of a video of a hand that moves and rests, the rests are taken; they calibrate") {
  const CameraModel truth = small_webcam();
  const Board board;
  Stream stream;
  const auto rests = board_poses(board, truth, 16, 21);
  Outcome last = Outcome::kNoBoard;
  int taken_in_motion = 0;
  for (std::size_t i = 0; i < rests.size(); ++i) {
    if (i > 0) {
      for (int step = 1; step < 6; ++step) {
        Pose pose;
        const double t = step / 6.0;
        pose.position = (1 - t) * rests[i - 1].position + t * rests[i].position;
        pose.orientation = with_positive_w(rests[i - 1].orientation.slerp(t, rests[i].orientation));
        const Outcome outcome = stream.offer(pose);
        if (step > 1 && outcome == Outcome::kTaken) ++taken_in_motion;
      }
    }
    stream.offer(rests[i]);
    last = stream.offer(rests[i]);
  }
  CHECK(last != Outcome::kNoBoard);
  const auto& views = stream.collector.views();
  CHECK(views.size() >= 14);
  // A jump of more than a tenth of the picture between two frames can't be told from a cut.
  CHECK(taken_in_motion < 30);
  std::vector<LumaView> pictures;
  for (const CollectedView& view : views) pictures.push_back(view.picture.view());
  const auto calibration = calibrate_from_pictures(pictures, board, {});
  CHECK(calibration.result.camera.fx == doctest::Approx(truth.fx).epsilon(1e-3));
  const auto advice = stream.collector.advice();
  for (const std::string& line : advice) MESSAGE(line);
  CHECK(advice.size() < 3);
}
