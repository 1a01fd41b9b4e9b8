#include "calibration/arena_watch.hpp"

#include <doctest/doctest.h>

#include "tests/calibration/arena_scene.hpp"

using namespace roundel;
using namespace roundel::test;

namespace {

// A camera at ten frames a second.
class Watching {
 public:
  explicit Watching(ArenaScene& scene) : watch_(calibrated(scene)) {}

  template <typename FrameMarkers>
  void show(double seconds, FrameMarkers&& markers) {
    for (int i = 0; i < static_cast<int>(10 * seconds); ++i) {
      watch_.add(markers(), time_us_ += 100'000);
    }
  }
  ArenaWatch::State state() const { return watch_.state(); }
  bool says(const std::string& part) const { return watch_.text().find(part) != std::string::npos; }

 private:
  ArenaWatch watch_;
  std::int64_t time_us_ = 0;
};

}  // namespace

TEST_CASE("corners in their places are confirmed") {
  ArenaScene scene;
  Watching watching(scene);
  CHECK(watching.state() == ArenaWatch::State::kUnknown);
  watching.show(5, [&] { return plain_corners(scene); });
  CHECK(watching.state() == ArenaWatch::State::kInPlace);
  CHECK(watching.says("4 of 4 fixed markers"));
}

TEST_CASE("a bumped camera is noticed within seconds, and its return as well") {
  ArenaScene scene;
  Watching watching(scene);
  const auto corners = [&] { return plain_corners(scene); };
  watching.show(5, corners);
  SUBCASE("turned by half a degree") {
    scene.look(0.009, 0.1);
  }
  SUBCASE("tilted by half a degree") {
    scene.look(0, 0.109);
  }
  SUBCASE("pushed by two centimetres") {
    scene.push({0.02, 0, 0});
  }
  SUBCASE("pushed far away") {
    scene.push({0.25, 0.1, 0.05});
  }
  watching.show(7, corners);
  CHECK(watching.state() == ArenaWatch::State::kCameraMoved);
  CHECK(watching.says("the camera has been moved"));
  CHECK(watching.says("the corner at (3, 2) by"));
  scene.look(0, 0.1);
  watching.show(5, corners);
  CHECK(watching.state() == ArenaWatch::State::kInPlace);
}

TEST_CASE("one corner that was kicked is no bumped camera") {
  ArenaScene scene;
  Watching watching(scene);
  watching.show(7, [&] {
    std::vector<Marker> markers = plain_corners(scene);
    markers[1] = scene.marker(-1, {3.03, 0.01, 0});
    return markers;
  });
  CHECK(watching.state() == ArenaWatch::State::kCornerMoved);
  CHECK(watching.says("the corner at (3, 0) by 3"));
}

TEST_CASE("a hand, a robot and a blackout pass without an alarm") {
  ArenaScene scene;
  Watching watching(scene);
  watching.show(5, [&] { return plain_corners(scene); });
  int frame = 0;
  watching.show(1.5, [&] {  // the hand at two corners
    std::vector<Marker> markers = plain_corners(scene);
    markers[0] = scene.marker(-1, {0.01, 0.02, 0});
    markers[1] = scene.marker(-1, {3.01, 0.02, 0});
    return markers;
  });
  CHECK(watching.state() == ArenaWatch::State::kInPlace);
  watching.show(10, [&] {  // two corners covered, unreadable robots drive about
    std::vector<Marker> markers = plain_corners(scene);
    markers.erase(markers.begin(), markers.begin() + 2);
    ++frame;
    markers.push_back(scene.marker(-1, {0.2 + 0.02 * frame, 0.3, 0.05}));
    markers.push_back(scene.marker(-1, {2.7 - 0.02 * frame, 0.4, 0.05}));
    return markers;
  });
  CHECK(watching.state() == ArenaWatch::State::kInPlace);
  watching.show(5, [] { return std::vector<Marker>(); });
  CHECK(watching.state() == ArenaWatch::State::kUnknown);
  CHECK(watching.says("none of the arena's fixed markers is in view"));
}

TEST_CASE("corners put down some millimetres off their places are no motion") {
  ArenaScene scene;
  const auto corners = [&] {
    std::vector<Marker> markers = plain_corners(scene);
    markers[2] = scene.marker(-1, {3.006, 1.995, 0});
    return markers;
  };
  ArenaWatch watch(shown(scene, three_by_two(), [&](int) { return corners(); }).result());
  for (int i = 0; i < 60; ++i) watch.add(corners(), i * 100'000);
  CHECK(watch.state() == ArenaWatch::State::kInPlace);
}
