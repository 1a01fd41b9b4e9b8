#include "calibration/arena_calibrator.hpp"

#include <doctest/doctest.h>

#include "tests/calibration/arena_scene.hpp"
#include "tests/error_of.hpp"

using namespace roundel;
using namespace roundel::test;

namespace {

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::vector<Marker> coded_corners(ArenaScene& scene, const std::vector<int>& ids) {
  std::vector<Marker> markers;
  const auto places = ArenaScene::corners();
  for (std::size_t i = 0; i < 4; ++i) markers.push_back(scene.marker(ids[i], places[i]));
  return markers;
}

// The arena that the request finds in these frames, as an error or as a pose.
template <typename FrameMarkers>
std::string refusal(const ArenaScene& scene, const ArenaRequest& request,
                    FrameMarkers&& frame_markers) {
  const ArenaCalibrator calibrator = shown(scene, request, frame_markers);
  try {
    calibrator.result();
  } catch (const ArenaRefusal& error) {
    return error.what();
  }
  return {};
}

}  // namespace

TEST_CASE("four plain corners give the arena, its residuals and its certainty") {
  ArenaScene scene;
  const ArenaCalibrator calibrator =
      shown(scene, three_by_two(), [&](int) { return plain_corners(scene); });
  CHECK(calibrator.progress().done);
  CHECK(calibrator.progress().markers == 4);
  const ArenaCalibration calibration = calibrator.result();
  CHECK(difference(calibration.arena_in_camera, scene.arena_in_camera()) < 0.0001);
  CHECK(calibration.certainty_m < 0.0001);
  CHECK(calibration.frames == 40);
  CHECK(calibration.size_by_markers == doctest::Approx(1).epsilon(0.001));
  REQUIRE(calibration.references.size() == 4);
  const auto places = ArenaScene::corners();
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK(calibration.references[i].place == places[i]);
    CHECK(calibration.references[i].residual.norm() < 0.0001);
    CHECK(std::abs(calibration.side_errors[i]) < 0.0001);
  }
}

TEST_CASE("the origin is the bottom-left corner of the image, and can be turned") {
  ArenaScene scene;
  ArenaRequest request = three_by_two();
  const auto origin_pixel = [&] {
    return shown(scene, request, [&](int) { return plain_corners(scene); })
        .result()
        .references[0]
        .pixel;
  };
  const Eigen::Vector2d bottom_left = origin_pixel();
  CHECK(bottom_left.x() < 960);
  CHECK(bottom_left.y() > 540);
  request.origin = ArenaOrigin::kTopRight;
  CHECK(origin_pixel().x() > 960);
  CHECK(origin_pixel().y() < 540);
  // Turned by a quarter, x runs along the image's right side.
  request.origin = ArenaOrigin::kBottomRight;
  std::swap(request.width_m, request.height_m);
  CHECK(origin_pixel().x() > 960);
  CHECK(origin_pixel().y() > 540);
  request.origin = ArenaOrigin::kTopLeft;
  CHECK(origin_pixel().x() < 960);
  CHECK(origin_pixel().y() < 540);
}

TEST_CASE("width and height exchanged are refused, and the message says so") {
  ArenaScene scene;
  ArenaRequest request = three_by_two();
  std::swap(request.width_m, request.height_m);
  const std::string why = refusal(scene, request, [&](int) { return plain_corners(scene); });
  CAPTURE(why);
  CHECK(has(why, "no rectangle of 2 x 3 m"));
  CHECK(has(why, "3 x 2 m would fit"));
  CHECK(has(why, "the sides are 3.00, 2.00, 3.00 and 2.00 m"));
}

TEST_CASE("a wrong size is refused with the numbers") {
  ArenaScene scene;
  ArenaRequest request = three_by_two();
  SUBCASE("one side") {
    request.height_m = 2.2;
    const std::string why = refusal(scene, request, [&](int) { return plain_corners(scene); });
    CAPTURE(why);
    CHECK(has(why, "no rectangle of 3 x 2.2 m"));
    CHECK(has(why, "mm is allowed"));
  }
  SUBCASE("both sides by the same factor: only the markers' own size tells") {
    request.width_m = 6;
    request.height_m = 4;
    const std::string why = refusal(scene, request, [&](int) { return plain_corners(scene); });
    CAPTURE(why);
    CHECK(has(why, "it is 3.00 x 2.00 m, not 6 x 4 m"));
  }
  SUBCASE("corner markers of another diameter are no wrong size if that is said") {
    request.width_m = 6;
    request.height_m = 4;
    request.corner_diameter_m = 2 * kDiameter;
    CHECK(refusal(scene, request, [&](int) { return plain_corners(scene); }).empty());
  }
}

TEST_CASE("a corner that was put down 40 mm off is refused, 4 mm are reported as residuals") {
  ArenaScene scene;
  double off = 0.04;
  const auto frame = [&](int) {
    std::vector<Marker> markers = plain_corners(scene);
    markers[2] = scene.marker(-1, {3 + off, 2 - off, 0});
    return markers;
  };
  CHECK(has(refusal(scene, three_by_two(), frame), "the corners are off by"));
  off = 0.004;
  const ArenaCalibration calibration = shown(scene, three_by_two(), frame).result();
  // Four corners have little to spare: the residual is shared out among them.
  CHECK(calibration.references[2].residual.norm() > 0.0003);
  CHECK(std::abs(calibration.side_errors[1]) > 0.0003);
}

TEST_CASE("a corner covered for a while does no harm, one covered most of the time is missed") {
  ArenaScene scene;
  int covered_until = 15;
  const auto frame = [&](int number) {
    std::vector<Marker> markers = plain_corners(scene);
    if (number < covered_until) markers.pop_back();
    return markers;
  };
  CHECK(difference(shown(scene, three_by_two(), frame).result().arena_in_camera,
                   scene.arena_in_camera()) < 0.0001);
  covered_until = 30;
  const std::string why = refusal(scene, three_by_two(), frame);
  CAPTURE(why);
  CHECK(has(why, "3 markers that could be a corner are in view and stand still, four are needed"));
}

TEST_CASE("a hand at a corner's edge, a robot driving by, a robot with an unreadable code") {
  ArenaScene scene;
  const auto frame = [&](int number) {
    std::vector<Marker> markers = plain_corners(scene);
    // The hand pulls the outline aside for a third of the time.
    if (number % 3 == 0) markers[1] = scene.marker(-1, {3.004, 0.003, 0});
    markers.push_back(scene.marker(5, {0.2 + 0.05 * number, 0.15, 0.05}));
    markers.push_back(scene.marker(-1, {0.3 + 0.04 * number, 1.2, 0.05}));
    return markers;
  };
  CHECK(difference(shown(scene, three_by_two(), frame).result().arena_in_camera,
                   scene.arena_in_camera()) < 0.0001);
}

TEST_CASE("of five plain markers the four that make the rectangle are the corners") {
  ArenaScene scene;
  SUBCASE("one more inside") {
    const auto frame = [&](int) {
      std::vector<Marker> markers = plain_corners(scene);
      markers.push_back(scene.marker(-1, {1, 0.8, 0}));
      return markers;
    };
    CHECK(difference(shown(scene, three_by_two(), frame).result().arena_in_camera,
                     scene.arena_in_camera()) < 0.0001);
  }
  SUBCASE("one more outside") {
    const auto frame = [&](int) {
      std::vector<Marker> markers = plain_corners(scene);
      markers.push_back(scene.marker(-1, {3.2, 1, 0}));
      return markers;
    };
    CHECK(difference(shown(scene, three_by_two(), frame).result().arena_in_camera,
                     scene.arena_in_camera()) < 0.0001);
  }
  SUBCASE("and if no four do, that is refused") {
    const auto frame = [&](int) {
      std::vector<Marker> markers = plain_corners(scene);
      markers[0] = scene.marker(-1, {0.3, 0.2, 0});
      markers.push_back(scene.marker(-1, {1.2, 1.1, 0}));
      return markers;
    };
    CHECK(has(refusal(scene, three_by_two(), frame), "are no rectangle of 3 x 2 m"));
  }
}

TEST_CASE("corners with codes are taken where there are no four plain ones") {
  ArenaScene scene;
  const auto frame = [&](int number) {
    std::vector<Marker> markers = coded_corners(scene, {9, 3, 7, 1});
    markers.push_back(scene.marker(5, {1.5, 1, 0.05}));  // a parked robot
    if (number % 4 == 0) markers[0].id = -1;             // now and then its code is not readable
    return markers;
  };
  const ArenaCalibration calibration = shown(scene, three_by_two(), frame).result();
  CHECK(calibration.references[0].id == 9);
  CHECK(calibration.references[3].id == 1);
  CHECK(difference(calibration.arena_in_camera, scene.arena_in_camera()) < 0.0001);
}

TEST_CASE("given ids are the corners in their order, whatever else there is") {
  ArenaScene scene;
  ArenaRequest request = three_by_two();
  request.ids = {11, 12, 13, 14};
  const auto frame = [&](int) {
    std::vector<Marker> markers = coded_corners(scene, {11, 12, 13, 14});
    for (const Marker& plain : plain_corners(scene)) {
      markers.push_back(plain);
      markers.back().u += 100;
    }
    return markers;
  };
  CHECK(difference(shown(scene, request, frame).result().arena_in_camera, scene.arena_in_camera()) <
        0.0001);

  SUBCASE("from the opposite corner: x and y run the other way") {
    request.ids = {13, 14, 11, 12};
    const Pose turned = shown(scene, request, frame).result().arena_in_camera;
    CHECK((turned.to_camera({0, 0, 0}) - scene.arena_in_camera().to_camera({3, 2, 0})).norm() <
          0.0001);
  }
  SUBCASE("mirrored") {
    request.ids = {11, 14, 13, 12};
    std::swap(request.width_m, request.height_m);
    const std::string why = refusal(scene, request, frame);
    CAPTURE(why);
    CHECK(has(why, "go round clockwise"));
    CHECK(has(why, "they are 11, 12, 13, 14"));
  }
  SUBCASE("crossing over") {
    request.ids = {11, 13, 12, 14};
    const std::string why = refusal(scene, request, frame);
    CAPTURE(why);
    CHECK(has(why, "not named in the order around the arena"));
    CHECK(has(why, "they are 11, 12, 13, 14"));
  }
}

TEST_CASE("what keeps a named corner from being used is said") {
  ArenaScene scene;
  ArenaRequest request = three_by_two();
  request.ids = {11, 12, 13, 14};
  const auto with = [&](auto&& change) {
    return refusal(scene, request, [&](int number) {
      std::vector<Marker> markers = coded_corners(scene, {11, 12, 13, 14});
      change(markers, number);
      return markers;
    });
  };
  CHECK(has(with([](auto& m, int) { m.erase(m.begin() + 1); }),
            "3 of the four corners are in view: marker 12 was not seen"));
  CHECK(has(with([](auto& m, int number) {
              if (number % 5 != 0) m.pop_back();
            }),
            "marker 14 was seen in only 20 % of the frames"));
  CHECK(has(with([&](auto& m, int number) {
              m[0] = scene.marker(11, {0.02 * number, 0, 0});
            }),
            "marker 11 does not stand still"));
  CHECK(has(with([&](auto& m, int) {
              m.push_back(scene.marker(13, {1, 1, 0}));
            }),
            "marker 13 is worn by two markers"));
}

TEST_CASE(
    "anchors make it better, stand in for a covered corner, and must be where they are said") {
  ArenaScene scene;
  ArenaRequest request = three_by_two();
  request.ids = {11, 12, 13, 14};
  request.anchors = {{21, 1.5, 0}, {22, 1.5, 2}, {23, 0.5, 1}};
  bool covered = false;
  double off = 0;
  const auto frame = [&](int) {
    std::vector<Marker> markers = coded_corners(scene, {11, 12, 13, 14});
    if (covered) markers.erase(markers.begin());
    markers.push_back(scene.marker(21, {1.5, 0, 0}));
    markers.push_back(scene.marker(22, {1.5 + off, 2, 0}));
    return markers;
  };
  ArenaCalibration calibration = shown(scene, request, frame).result();
  CHECK(calibration.references.size() == 6);
  CHECK(difference(calibration.arena_in_camera, scene.arena_in_camera()) < 0.0001);
  covered = true;
  calibration = shown(scene, request, frame).result();
  CHECK(calibration.references.size() == 5);
  CHECK(difference(calibration.arena_in_camera, scene.arena_in_camera()) < 0.0001);
  covered = false;
  off = 0.06;
  CHECK(has(refusal(scene, request, frame), "should be at (1.5, 2)"));
}

TEST_CASE("corners on boards: the floor is where it is, not at the markers' faces") {
  ArenaScene scene;
  ArenaRequest request = three_by_two();
  request.corner_height_m = 0.04;
  const auto frame = [&](int) {
    std::vector<Marker> markers;
    for (Eigen::Vector3d place : ArenaScene::corners()) {
      place.z() = 0.04;
      markers.push_back(scene.marker(-1, place));
    }
    return markers;
  };
  CHECK(difference(shown(scene, request, frame).result().arena_in_camera, scene.arena_in_camera()) <
        0.0001);
}

TEST_CASE("a certainty that is not reached is refused with what was reached") {
  ArenaScene scene;
  ArenaRequest request = three_by_two();
  request.certainty_m = 0.000001;
  const ArenaCalibrator calibrator =
      shown(scene, request, [&](int) { return plain_corners(scene); });
  CHECK_FALSE(calibrator.progress().done);
  CHECK(calibrator.progress().certainty_m.has_value());
  CHECK(has(error_of([&] { calibrator.result(); }), "is only certain to 0.0"));
}

TEST_CASE("without frames there is no calibration") {
  const ArenaScene scene;
  const ArenaCalibrator calibrator(three_by_two(), scene.arena_camera(), kDiameter);
  CHECK(calibrator.progress().text == "waiting for frames");
  CHECK(has(error_of([&] { calibrator.result(); }), "only 0 frames came"));
}

TEST_CASE("requests that make no sense are refused") {
  const auto error = [](auto&& change) {
    ArenaRequest request = three_by_two();
    change(request);
    return error_of([&] { check(request); });
  };
  CHECK(error([](ArenaRequest&) {}).empty());
  CHECK(has(error([](ArenaRequest& r) { r.width_m = 0; }), "width and height"));
  CHECK(has(error([](ArenaRequest& r) { r.height_m = NAN; }), "width and height"));
  CHECK(has(error([](ArenaRequest& r) { r.ids = {1, 2, 3}; }), "not 3"));
  CHECK(has(error([](ArenaRequest& r) { r.ids = {1, 2, 3, 3}; }), "id 3 is named twice"));
  CHECK(has(error([](ArenaRequest& r) { r.ids = {1, 2, 3, 0}; }), "id 0 does not exist"));
  CHECK(has(error([](ArenaRequest& r) { r.anchors = {{4, INFINITY, 0}}; }), "anchor 4"));
  CHECK(has(error([](ArenaRequest& r) { r.certainty_m = 0; }), "certainty"));
  CHECK(has(error([](ArenaRequest& r) { r.time_limit_s = -1; }), "time limit"));
}
