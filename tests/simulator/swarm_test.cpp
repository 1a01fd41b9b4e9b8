#include "simulator/swarm.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "simulator/arena.hpp"

using namespace roundel;

namespace {

constexpr double kStep = 0.005;

double closest(const Swarm& swarm, const SwarmOptions& options) {
  double distance = 1e9;
  const auto& robots = swarm.robots();
  for (std::size_t i = 0; i < robots.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      distance = std::min(distance, (robots[i].position - robots[j].position).norm());
    }
    for (const auto& o : options.obstacles) {
      distance = std::min(distance, (robots[i].position - o).norm());
    }
  }
  return distance;
}

SwarmOptions with_corners() {
  SwarmOptions options;
  options.obstacles = {{0, 0}, {3, 0}, {3, 2}, {0, 2}};
  return options;
}

}  // namespace

TEST_CASE("robots never touch each other, the corner markers or the border") {
  for (const bool close : {false, true}) {
    for (const int count : {2, 12, 60}) {
      SwarmOptions options = with_corners();
      options.robots = count;
      options.close_passes = close;
      Swarm swarm(options);
      double nearest = 1e9;
      bool inside = true;
      for (int k = 0; k < 6000; ++k) {
        swarm.step(kStep);
        nearest = std::min(nearest, closest(swarm, options));
        for (const Robot& robot : swarm.robots()) {
          inside = inside && robot.position.x() >= options.radius_m &&
                   robot.position.x() <= options.length_m - options.radius_m &&
                   robot.position.y() >= options.radius_m &&
                   robot.position.y() <= options.width_m - options.radius_m;
        }
      }
      CAPTURE(close);
      CAPTURE(count);
      CHECK(nearest >= 2 * options.radius_m + swarm.min_gap_m() - 1e-12);
      CHECK(inside);
    }
  }
}

TEST_CASE(
    "robots keep the speed and turn limits, drive forward along their heading, and get about") {
  const SwarmOptions options = with_corners();
  Swarm swarm(options);
  double top_speed = 0, top_turn = 0, sideways = 0, way = 0;
  std::vector<Robot> before = swarm.robots();
  for (int k = 0; k < 12000; ++k) {
    swarm.step(kStep);
    for (std::size_t i = 0; i < before.size(); ++i) {
      const Robot& robot = swarm.robots()[i];
      const Eigen::Vector2d velocity = (robot.position - before[i].position) / kStep;
      top_speed = std::max(top_speed, velocity.norm());
      way += velocity.norm() * kStep;
      sideways = std::max(sideways, (velocity - robot.heading * robot.speed).norm());
      const double turn = std::atan2(
          before[i].heading.x() * robot.heading.y() - before[i].heading.y() * robot.heading.x(),
          before[i].heading.dot(robot.heading));
      top_turn = std::max(top_turn, std::abs(turn) / kStep);
      CHECK(std::abs(robot.heading.norm() - 1) < 1e-12);
    }
    before = swarm.robots();
  }
  CHECK(top_speed <= options.max_speed + 1e-9);
  CHECK(top_turn <= options.max_turn_rate * 1.0001);
  CHECK(sideways < 1e-9);
  CHECK(top_speed > 0.9 * options.max_speed);
  CHECK(way / 60 / 12 > 0.1);  // metres a second, on average
}

TEST_CASE("speed changes gradually but for rare emergency stops") {
  Swarm swarm(with_corners());
  std::vector<Robot> before = swarm.robots();
  int abrupt = 0, steps = 0;
  for (int k = 0; k < 12000; ++k) {
    swarm.step(kStep);
    for (std::size_t i = 0; i < before.size(); ++i, ++steps) {
      const double change = swarm.robots()[i].speed - before[i].speed;
      CHECK(change < 0.6 * kStep + 1e-9);
      abrupt += change < -2.0 * kStep - 1e-9 ? 1 : 0;
    }
    before = swarm.robots();
  }
  CHECK(abrupt < steps / 1000);
}

TEST_CASE("close passes bring plates within a few millimetres, again and again") {
  SwarmOptions options = with_corners();
  options.close_passes = true;
  Swarm swarm(options);
  int passes = 0;
  std::vector<char> near(12 * 12, 0);
  for (int k = 0; k < 6000; ++k) {  // half a minute
    swarm.step(kStep);
    for (std::size_t i = 0; i < 12; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const auto& robots = swarm.robots();
        const double gap = (robots[i].position - robots[j].position).norm() - 2 * options.radius_m;
        char& was_near = near[i * 12 + j];
        if (gap < 0.006 && was_near == 0) {
          was_near = 1;
          ++passes;
        }
        if (gap > 0.05) was_near = 0;
      }
    }
  }
  CHECK(passes > 10);
}

TEST_CASE("in an arena, velocity and turn rate are those of the truth from frame to frame") {
  ArenaOptions options;
  options.image_width = 640;
  options.image_height = 360;
  options.frame_rate = 100;
  Arena arena(options);
  std::vector<MarkerTruth> before = arena.truth(0).markers;
  double fastest = 0;
  for (std::int64_t frame = 1; frame < 500; ++frame) {
    const auto& now = arena.truth(frame).markers;
    for (std::size_t i = 0; i < now.size(); ++i) {
      const double speed = std::hypot(now[i].x - before[i].x, now[i].y - before[i].y) * 100;
      const double turn = std::remainder(now[i].heading - before[i].heading, 2 * 3.14159265358979);
      CHECK(speed <= 0.3 + 1e-9);
      CHECK(std::abs(turn) * 100 <= 1.5 * 1.0001);
      fastest = std::max(fastest, speed);
    }
    CHECK(arena.clearance_m(frame) >= 0.015 - 1e-9);
    before = now;
  }
  CHECK(fastest > 0.2);
}
