#include "simulator/arena.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "tests/error_of.hpp"
#include "tests/simulator/reference.hpp"

using namespace roundel;
using reference::Vector2d;
using reference::Vector3d;

namespace {

ArenaOptions small_arena() {
  ArenaOptions options;
  options.image_width = 640;
  options.image_height = 360;
  return options;
}

double wrapped(double angle) {
  return std::remainder(angle, 2 * std::numbers::pi);
}

// The message with which an arena of these options is refused.
std::string refusal(const ArenaOptions& options) {
  return error_of([&] { const Arena arena(options); });
}

bool mentions(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("the default arena shows four plain corners and twelve robots with ids 1 to 12") {
  Arena arena{ArenaOptions{}};
  const FrameTruth& truth = arena.truth(0);
  REQUIRE(truth.markers.size() == 16);
  for (std::size_t i = 0; i < 16; ++i) {
    const MarkerTruth& m = truth.markers[i];
    CAPTURE(i);
    CHECK(m.visible);
    CHECK(m.kind == (i < 4 ? MarkerKind::WhyCon : MarkerKind::WhyCode));
    CHECK(m.id == (i < 4 ? -1 : static_cast<int>(i) - 3));
  }
  // The order of DESIGN section 3: x from the first corner to the second, y to the fourth.
  const auto corner = [&](std::size_t k) {
    return Vector2d(truth.markers[k].x, truth.markers[k].y);
  };
  CHECK(corner(0) == Vector2d(0, 0));
  CHECK(corner(1) == Vector2d(3, 0));
  CHECK(corner(2) == Vector2d(3, 2));
  CHECK(corner(3) == Vector2d(0, 2));
  CHECK(truth.markers[1].u > truth.markers[0].u);  // x to the right, y up in the picture
  CHECK(truth.markers[3].v < truth.markers[0].v);
  CHECK(arena.camera().fx == doctest::Approx(1452));
  CHECK(arena.camera().distortion.k1 == -0.28);
}

TEST_CASE("truth agrees with the camera, the poses and the arena frame") {
  ArenaOptions options = small_arena();
  options.camera_tilt = 0.03;
  options.camera_turn = -0.2;
  options.camera_height_m = 3.4;
  Arena arena(options);
  const Pose arena_in_camera = arena.arena_in_camera();
  for (const std::int64_t frame : {0, 1, 50, 300}) {
    const FrameTruth& truth = arena.truth(frame);
    CHECK(truth.frame == frame);
    CHECK(truth.time_s == doctest::Approx(static_cast<double>(frame) / 30));
    for (const MarkerTruth& m : truth.markers) {
      const Vector2d pixel = reference::project(arena.camera(), m.pose.position);
      CHECK(std::abs(pixel.x() - m.u) < 1e-9);
      CHECK(std::abs(pixel.y() - m.v) < 1e-9);
      CHECK(m.pose.orientation.norm() == doctest::Approx(1).epsilon(1e-12));
      CHECK(m.pose.orientation.w() >= 0);
      const Eigen::Quaterniond to_arena = arena_in_camera.orientation.conjugate();
      const Vector3d place = to_arena * (m.pose.position - arena_in_camera.position);
      CHECK((place - Vector3d(m.x, m.y, m.z)).norm() < 1e-12);
      const Vector3d x_axis = to_arena * (m.pose.orientation * Vector3d::UnitX());
      CHECK(std::abs(wrapped(std::atan2(x_axis.y(), x_axis.x()) - m.heading)) < 1e-12);
      CHECK((to_arena * m.pose.normal() - Vector3d::UnitZ()).norm() < 1e-12);
      CHECK(m.heading > -std::numbers::pi);
      CHECK(m.heading <= std::numbers::pi);
    }
  }
  // The camera's height above the floor, and the arena's middle on the optical axis.
  const Vector3d eye = arena_in_camera.orientation.conjugate() * (-arena_in_camera.position).eval();
  CHECK(eye.z() == doctest::Approx(3.4));
  const Vector3d middle = arena_in_camera.to_camera({1.5, 1, 0});
  CHECK(middle.head<2>().norm() < 1e-12);
}

TEST_CASE("robots' markers are where truth says, in the picture") {
  ArenaOptions options;
  options.clutter = false;
  options.imaging = {};
  options.imaging.floor = options.imaging.white;
  options.bits = 0;
  Arena arena(options);
  GreyImage image;
  arena.render(77, image);
  for (const MarkerTruth& m : arena.truth(77).markers) {
    REQUIRE(m.visible);
    // Centroid of the dark pixels around it, against the same for the analytic outlines.
    double area = 0;
    Vector2d sum(0, 0);
    const int u0 = static_cast<int>(m.u), v0 = static_cast<int>(m.v);
    for (int v = v0 - 37; v <= v0 + 37; ++v) {
      for (int u = u0 - 37; u <= u0 + 37; ++u) {
        if (std::hypot(u - m.u, v - m.v) > 36 || u < 0 || v < 0) continue;
        const double dark = options.imaging.white - image.view().at(u, v);
        area += dark;
        sum += dark * Vector2d(u, v);
      }
    }
    const auto outer = reference::disc_image(arena.camera(), m.pose, 0.061, 4000);
    const auto inner = reference::disc_image(arena.camera(), m.pose, 0.025, 4000);
    const Vector2d expected =
        (outer.area * outer.centroid - inner.area * inner.centroid) / (outer.area - inner.area);
    CHECK((sum / area - expected).norm() < 0.005);
  }
}

TEST_CASE("a frame depends on its number alone, not on the frames drawn before") {
  ArenaOptions options = small_arena();
  options.occluder = true;
  options.imaging.gradient = 0.2;
  options.imaging.gamma = 2.2;
  Arena forward(options);
  GreyImage image;
  std::vector<GreyImage> frames;
  for (std::int64_t frame = 0; frame <= 20; ++frame) {
    forward.render(frame, image);
    frames.push_back(image);
  }
  for (const std::int64_t frame : {0, 1, 20}) {
    GreyImage alone;
    Arena fresh(options);
    fresh.render(frame, alone);
    CHECK(alone.pixels == frames[static_cast<std::size_t>(frame)].pixels);
  }
  forward.render(5, image);  // back again
  CHECK(image.pixels == frames[5].pixels);
  CHECK(frames[5].pixels != frames[6].pixels);
}

TEST_CASE("the seed decides about the motion, the light does not") {
  ArenaOptions options = small_arena();
  Arena first(options);
  options.imaging.white = 150;
  options.imaging.noise_sigma = 8;
  Arena second(options);
  options.seed = 2;
  Arena third(options);
  const auto place = [](Arena& arena) {
    const MarkerTruth& m = arena.truth(30).markers.back();
    return Vector3d(m.x, m.y, m.heading);
  };
  CHECK(place(first) == place(second));
  CHECK(place(first) != place(third));
}

TEST_CASE("what a bar above the arena covers is not visible, and what is visible is untouched") {
  ArenaOptions options;
  options.imaging.exposure_s = 0;
  ArenaOptions with_bar = options;
  with_bar.occluder = true;
  Arena open(options), barred(with_bar);
  GreyImage open_image, barred_image;
  int hidden = 0, touched = 0;
  for (std::int64_t frame = 0; frame < 400; frame += 40) {
    open.render(frame, open_image);
    barred.render(frame, barred_image);
    const auto& free_markers = open.truth(frame).markers;
    const auto& markers = barred.truth(frame).markers;
    for (std::size_t i = 0; i < markers.size(); ++i) {
      REQUIRE(markers[i].u == free_markers[i].u);
      if (!free_markers[i].visible) continue;
      // Noise is the same in both: any pixel that differs is the bar's.
      const auto outline = reference::disc_image(open.camera(), markers[i].pose, 0.061, 100);
      const double radius = std::sqrt(outline.area / std::numbers::pi) - 3;
      int differing = 0;
      const int u0 = static_cast<int>(outline.centroid.x() - radius);
      const int v0 = static_cast<int>(outline.centroid.y() - radius);
      const int size = static_cast<int>(2 * radius) + 1;
      for (int v = v0; v <= v0 + size; ++v) {
        for (int u = u0; u <= u0 + size; ++u) {
          if ((Vector2d(u, v) - outline.centroid).norm() > radius) continue;
          differing += open_image.view().at(u, v) != barred_image.view().at(u, v) ? 1 : 0;
        }
      }
      if (markers[i].visible) CHECK(differing == 0);
      hidden += markers[i].visible ? 0 : 1;
      touched += differing > 0 ? 1 : 0;
    }
  }
  CHECK(touched > 3);
  // Not many more than those are called hidden: the margin is a few pixels.
  CHECK(hidden >= touched);
  CHECK(hidden < 3 * touched);
}

TEST_CASE("a higher robot hides a lower one beside it when seen aslant") {
  ArenaOptions options;
  options.close_passes = true;
  options.min_height_m = 0;
  options.max_height_m = 0.5;
  options.robots = 14;
  Arena arena(options);
  int hidden = 0;
  for (std::int64_t frame = 0; frame < 900; frame += 30) {
    for (const MarkerTruth& m : arena.truth(frame).markers) {
      if (m.visible) continue;
      ++hidden;
      // Somebody higher is near enough in the picture to be in the way.
      bool cause = false;
      for (const MarkerTruth& other : arena.truth(frame).markers) {
        const double apart = std::hypot(m.u - other.u, m.v - other.v);
        cause = cause || (other.z > m.z && apart < 100);
      }
      CHECK(cause);
    }
  }
  CHECK(hidden > 0);
}

TEST_CASE("a marker at the image's border is not visible") {
  ArenaOptions options;
  options.camera = reference::webcam();
  options.camera->fx = options.camera->fy = 2300;  // too long a lens: corners are cut off
  options.clutter = false;
  Arena arena(options);
  int outside = 0;
  for (const MarkerTruth& m : arena.truth(0).markers) {
    const auto outline = reference::disc_image(arena.camera(), m.pose, 0.061, 100);
    const double radius = std::sqrt(outline.area / std::numbers::pi);
    const bool well_inside = m.u > radius + 15 && m.v > radius + 15 && m.u < 1919 - radius - 15 &&
                             m.v < 1079 - radius - 15;
    const bool cut = m.u < radius || m.v < radius || m.u > 1919 - radius || m.v > 1079 - radius;
    if (cut) {
      CHECK_FALSE(m.visible);
      ++outside;
    }
    if (well_inside) CHECK(m.visible);
  }
  CHECK(outside >= 4);
}

TEST_CASE("the lens is chosen so that the whole arena is in the picture, at any size") {
  for (const auto& [width, height] : {std::pair{640, 480}, {1280, 720}, {320, 240}, {2592, 1944}}) {
    for (const double tilt : {0.0, 0.3}) {
      ArenaOptions options;
      options.image_width = width;
      options.image_height = height;
      options.camera_tilt = tilt;
      options.clutter = false;
      Arena arena(options);
      CHECK(arena.camera().width == width);
      CHECK(arena.camera().height == height);
      for (const std::int64_t frame : {0, 200}) {
        for (const MarkerTruth& m : arena.truth(frame).markers) {
          CHECK(m.u > 8);
          CHECK(m.v > 8);
          CHECK(m.u < width - 9);
          CHECK(m.v < height - 9);
        }
      }
    }
  }
  ArenaOptions low;
  low.camera_height_m = 0.5;
  CHECK(mentions(refusal(low), "camera_height_m"));
}

TEST_CASE("more robots than ids are refused, naming how many there are and what would do") {
  ArenaOptions options = small_arena();
  options.bits = 4;
  const std::string message = refusal(options);
  CHECK(mentions(message, "12 ids"));
  CHECK(mentions(message, "4-bit codes with Hamming distance 1 have 3"));
  CHECK(mentions(message, "7 bits would do (18 ids)"));
  options.hamming = 3;
  options.bits = 8;
  CHECK(mentions(refusal(options), "12 bits would do (16 ids)"));
  options.hamming = 4;
  options.robots = 100;
  CHECK(mentions(refusal(options), "no code up to 16 bits"));
  options = small_arena();
  options.bits = 8;
  options.robots = 30;
  CHECK(refusal(options).empty());  // exactly as many as there are
  options.corner_kind = MarkerKind::WhyCode;
  CHECK(mentions(refusal(options), "34 ids"));
}

TEST_CASE("robots wear the ids that were asked for") {
  ArenaOptions options = small_arena();
  options.robots = 3;
  options.robot_ids = {30, 7, 7};
  Arena arena(options);
  const auto& markers = arena.truth(0).markers;
  CHECK(markers[4].id == 30);
  CHECK(markers[5].id == 7);
  CHECK(markers[6].id == 7);
  options.robot_ids = {1, 2};
  CHECK(mentions(refusal(options), "2 ids for 3 robots"));
  options.robot_ids = {1, 2, 31};
  CHECK(mentions(refusal(options), "id 31 does not exist"));
  options.robot_ids = {};
  options.corner_kind = MarkerKind::WhyCode;
  Arena coded(options);
  CHECK(coded.truth(0).markers[0].id == 4);
  CHECK(coded.truth(0).markers[3].id == 7);
}

TEST_CASE("robots that do not fit on the floor are refused with the number that does") {
  ArenaOptions options = small_arena();
  options.bits = 12;
  options.robots = 300;
  CHECK(mentions(refusal(options), "at most"));
  options.diameter_m = 0.05;
  Arena arena(options);
  CHECK(arena.truth(0).markers.size() == 304);
  CHECK(arena.clearance_m(0) > 0);
  CHECK(arena.clearance_m(30) > 0);
}

TEST_CASE("options out of range are refused") {
  const auto refused = [](auto change) {
    ArenaOptions options = small_arena();
    change(options);
    CHECK_FALSE(refusal(options).empty());
  };
  refused([](ArenaOptions& o) { o.frame_rate = 0; });
  refused([](ArenaOptions& o) { o.robots = -1; });
  refused([](ArenaOptions& o) { o.diameter_m = std::nan(""); });
  refused([](ArenaOptions& o) { o.bits = 17; });
  refused([](ArenaOptions& o) { o.bits = 1; });
  refused([](ArenaOptions& o) { o.hamming = 5; });
  refused([](ArenaOptions& o) { o.min_height_m = 0.2; });
  refused([](ArenaOptions& o) { o.length_m = -3; });
  refused([](ArenaOptions& o) { o.image_width = 0; });
  refused([](ArenaOptions& o) { o.imaging.blur_px = -1; });
  CHECK_THROWS_AS(Arena(small_arena()).truth(-1), std::invalid_argument);
}

TEST_CASE("an arena without robots, corners and clutter is an empty floor") {
  ArenaOptions options = small_arena();
  options.robots = 0;
  options.corners = false;
  options.clutter = false;
  options.imaging = {};
  Arena arena(options);
  GreyImage image;
  arena.render(3, image);
  CHECK(arena.truth(3).markers.empty());
  CHECK(image.pixels == std::vector<std::uint8_t>(640 * 360, 120));
}
