#include "simulator/clutter.hpp"

#include <Eigen/Geometry>

#include "simulator/random.hpp"

namespace roundel {

namespace {

constexpr int kThings = 48;
constexpr double kAround = 0.4;  // metres of littered floor outside of the arena
constexpr double kDark = 45, kBright = 205;

SceneShape distractor(int kind, Random& random) {
  SceneShape s;
  s.width_m = s.height_m = random.uniform(0.05, 0.16);
  s.grey = random.uniform(25, 60);
  s.hole_grey = random.uniform(180, 225);
  switch (kind) {
    case 0:  // a lid
      break;
    case 1:  // a roll of tape from above
      s.hole_ratio = random.uniform(0.80, 0.92);
      break;
    case 2:  // a washer with a small hole
      s.hole_ratio = random.uniform(0.10, 0.18);
      break;
    case 3:  // a picture frame
      s.outline = s.hole = Outline::Rectangle;
      s.hole_ratio = random.uniform(0.35, 0.6);
      break;
    case 4:  // a box with a round hole
      s.outline = Outline::Rectangle;
      s.hole_ratio = random.uniform(0.35, 0.6);
      break;
    case 5:  // a disc with a square hole
      s.hole = Outline::Rectangle;
      s.hole_ratio = random.uniform(0.35, 0.55);
      break;
    case 6:  // a ring whose hole is off the centre
      s.hole_ratio = random.uniform(0.35, 0.5);
      s.hole_offset_m = {0.2 * s.width_m, 0};
      break;
    default:  // a washed-out ring
      s.hole_ratio = random.uniform(0.4, 0.5);
      s.grey = 112;
      s.hole_grey = 124;
      break;
  }
  return s;
}

SceneShape plain_thing(int kind, Random& random) {
  SceneShape s;
  s.outline = Outline::Rectangle;
  switch (kind) {
    case 0:  // a sheet of paper with a dark block of print
      s.width_m = 0.21;
      s.height_m = 0.297;
      s.grey = kBright;
      s.hole = Outline::Rectangle;
      s.hole_ratio = random.uniform(0.2, 0.7);
      s.hole_grey = random.uniform(60, 150);
      break;
    case 1:  // a cable
      s.width_m = random.uniform(0.3, 1.2);
      s.height_m = random.uniform(0.004, 0.012);
      s.grey = kDark;
      break;
    default:  // a box
      s.width_m = random.uniform(0.03, 0.3);
      s.height_m = random.uniform(0.03, 0.3);
      s.grey = random.uniform(30, 210);
      break;
  }
  return s;
}

}  // namespace

std::vector<SceneShape> arena_clutter(std::uint64_t seed, double length_m, double width_m,
                                      const Pose& arena_in_camera) {
  Random random(seed);
  std::vector<SceneShape> things;
  for (int i = 0; i < kThings; ++i) {
    SceneShape s = i % 2 == 0 ? distractor(i / 2 % 8, random) : plain_thing(i / 2 % 3, random);
    const Eigen::Vector3d place(random.uniform(-kAround, length_m + kAround),
                                random.uniform(-kAround, width_m + kAround), 0);
    const Eigen::Quaterniond turn(
        Eigen::AngleAxisd(random.uniform(-3.14, 3.14), Eigen::Vector3d::UnitZ()));
    s.pose.position = arena_in_camera.to_camera(place);
    s.pose.orientation = with_positive_w(arena_in_camera.orientation * turn);
    things.push_back(s);
  }
  return things;
}

}  // namespace roundel
