#include "core/tracker.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <numbers>
#include <set>
#include <vector>

#include "core/necklace.hpp"
#include "tests/painter.hpp"

using namespace roundel;  // NOLINT(google-build-using-namespace)
using roundel::test::Painter;

namespace {

CameraModel camera_of(int width, int height) {
  CameraModel camera;
  camera.width = width;
  camera.height = height;
  camera.fx = camera.fy = 400;
  camera.cx = width / 2.0;
  camera.cy = height / 2.0;
  return camera;
}

// Lying flat before the camera, printed face up, turned by yaw; (x, y) in metres at 1 m.
Pose flat(double x, double y, double yaw) {
  const Eigen::Quaterniond facing(Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX()));
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()));
  return {{x, y, 1.0}, with_positive_w(facing * turn)};
}

const Marker* find_id(std::span<const Marker> markers, int id) {
  const auto it =
      std::find_if(markers.begin(), markers.end(), [id](const Marker& m) { return m.id == id; });
  return it == markers.end() ? nullptr : &*it;
}

struct Robot {
  int id;
  double x, y, yaw;
};

}  // namespace

namespace {

class Film {
 public:
  Film(int width, int height) : camera(camera_of(width, height)), code(8, 1), tracker({}, camera) {}

  std::span<const Marker> show(const std::vector<Robot>& robots, double light = 1) {
    Painter painter(camera, {35 * light, 215 * light, 120 * light});
    for (const Robot& r : robots) {
      painter.add({8, *code.word(r.id), 0, 0.08}, flat(r.x, r.y, r.yaw));
    }
    painter.add_noise(2, ++frame);
    return tracker.track(painter.view());
  }

  CameraModel camera;
  NecklaceCode code;
  Tracker tracker;
  std::uint64_t frame = 0;
};

}  // namespace

TEST_CASE("a moving marker keeps its track number and id") {
  Film film(320, 240);
  for (int i = 0; i < 25; ++i) {
    const auto markers = film.show({{6, -0.2 + 0.012 * i, 0.1 - 0.006 * i, 0.1 * i}});
    CAPTURE(i);
    REQUIRE(markers.size() == 1);
    CHECK(markers[0].track == 1);
    CHECK(markers[0].id == 6);
  }
}

TEST_CASE(
    "a marker that jumps by more than its size is found in the same frame as the same track") {
  Film film(320, 240);
  film.show({{6, -0.2, 0, 0}});
  for (const double x : {0.0, -0.2, 0.15, 0.0}) {
    const auto markers = film.show({{6, x, 0.05, 0}});
    REQUIRE(markers.size() == 1);
    CHECK(markers[0].track == 1);
    CHECK(markers[0].id == 6);
  }
}

TEST_CASE("a newcomer is found within five frames while others are tracked") {
  for (const double y : {-0.2, -0.1, 0.0, 0.1, 0.2}) {
    Film film(320, 240);
    film.show({{6, -0.2, 0, 0}});
    int frames = 0;
    while (!find_id(film.show({{6, -0.2, 0, 0}, {9, 0.2, y, 0}}), 9) && frames < 10) ++frames;
    CAPTURE(y);
    CHECK(frames < 5);
  }
}

TEST_CASE("a covered marker is not reported, and comes back as the same track") {
  Film film(320, 240);
  for (int i = 0; i < 4; ++i) film.show({{6, 0, 0, 0}, {9, 0.2, 0, 0}});
  const std::int64_t track = find_id(film.show({{6, 0, 0, 0}, {9, 0.2, 0, 0}}), 9)->track;
  for (int i = 0; i < 8; ++i) {
    const auto markers = film.show({{6, 0, 0, 0}});
    CHECK(markers.size() == 1);
    CHECK(markers[0].id == 6);
  }
  const Marker* back = nullptr;
  for (int i = 0; i < 5 && !back; ++i) {
    back = find_id(film.show({{6, 0, 0, 0}, {9, 0.21, 0.01, 0}}), 9);
  }
  REQUIRE(back);
  CHECK(back->track == track);
}

TEST_CASE("a light step loses no track") {
  Film film(320, 240);
  for (const double light : {1.0, 1.0, 0.25, 0.25, 1.1, 0.5}) {
    const auto markers = film.show({{6, -0.1, 0, 0}, {9, 0.2, 0, 0}}, light);
    CAPTURE(light);
    REQUIRE(markers.size() == 2);
    CHECK(find_id(markers, 6));
    CHECK(find_id(markers, 9));
    for (const Marker& marker : markers) CHECK(marker.track <= 2);
  }
}

TEST_CASE("two robots that change places between frames keep their ids") {
  Film film(320, 240);
  std::map<int, std::int64_t> tracks;
  for (int i = 0; i < 5; ++i) {
    for (const Marker& m : film.show({{6, -0.1, 0, 0}, {9, 0.1, 0, 0}})) tracks[m.id] = m.track;
  }
  const auto markers = film.show({{9, -0.1, 0, 0}, {6, 0.1, 0, 0}});
  REQUIRE(markers.size() == 2);
  for (const Marker& marker : markers) {
    CHECK(marker.track == tracks[marker.id]);
    CHECK((marker.pose.position.x() > 0) == (marker.id == 6));
  }
}

TEST_CASE("two markers with one id are two tracks") {
  Film film(320, 240);
  std::set<std::int64_t> tracks;
  for (int i = 0; i < 6; ++i) {
    const auto markers = film.show({{6, -0.1, 0.01 * i, 0}, {6, 0.1, 0, 0}});
    REQUIRE(markers.size() == 2);
    for (const Marker& marker : markers) {
      CHECK(marker.id == 6);
      tracks.insert(marker.track);
    }
  }
  CHECK(tracks.size() == 2);
}

TEST_CASE("an empty frame has no markers, and a marker gone for long starts a new track") {
  Film film(320, 240);
  film.show({{6, 0, 0, 0}});
  for (int i = 0; i < 40; ++i) CHECK(film.show({}).empty());
  const auto markers = film.show({{6, 0, 0, 0}});
  REQUIRE(markers.size() == 1);
  CHECK(markers[0].track == 2);
}

TEST_CASE("no more markers are reported than allowed") {
  const CameraModel camera = camera_of(320, 240);
  const NecklaceCode code(8, 1);
  DetectorParameters parameters;
  parameters.max_markers = 3;
  Tracker tracker(parameters, camera);
  Painter painter(camera, {});
  for (int i = 0; i < 6; ++i) {
    painter.add({8, *code.word(i + 1), 0, 0.08},
                flat(-0.25 + 0.25 * (i % 3), i < 3 ? -0.1 : 0.1, 0));
  }
  for (int i = 0; i < 7; ++i) CHECK(tracker.track(painter.view()).size() == 3);
}

TEST_CASE("after a reset tracks begin anew under new numbers") {
  Film film(320, 240);
  film.show({{6, 0, 0, 0}});
  film.tracker.reset();
  const auto markers = film.show({{6, 0, 0, 0}});
  REQUIRE(markers.size() == 1);
  CHECK(markers[0].track == 2);
}

TEST_CASE("the stages of a frame are timed by the clock that is given, and by none otherwise") {
  static std::int64_t now_ns;
  now_ns = 5;
  Film film(640, 480);
  film.show({{7, 0, 0, 0}});
  CHECK(film.tracker.stage_times().following_ns == 0);
  film.tracker.time_stages([] { return now_ns *= 2; });
  film.show({{7, 0, 0, 0}});
  CHECK(film.tracker.stage_times().following_ns == 10);
  CHECK(film.tracker.stage_times().searching_ns == 20);
  CHECK(film.tracker.stage_times().identifying_ns == 40);
  film.tracker.time_stages(nullptr);
  film.show({{7, 0, 0, 0}});
  CHECK(film.tracker.stage_times().identifying_ns == 0);
}
