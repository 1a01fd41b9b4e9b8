#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace roundel {

// A round robot on the floor, arena frame.
struct Robot {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  // metres
  Eigen::Vector2d heading = Eigen::Vector2d::UnitX();  // unit vector; it drives this way
  double speed = 0;                                    // m/s, >= 0
  double turn_rate = 0;                                // rad/s, counter-clockwise
  Eigen::Vector2d goal = Eigen::Vector2d::Zero();
  double goal_time_s = 0;  // until it gives up on the goal
  bool seeks = false;      // its goal leads close past another robot
};

struct SwarmOptions {
  int robots = 12;
  double length_m = 3, width_m = 2;        // of the floor, along x and y
  double radius_m = 0.08;                  // of a robot
  double max_speed = 0.3;                  // m/s
  double max_turn_rate = 1.5;              // rad/s
  bool close_passes = false;               // seek each other and pass within millimetres
  std::vector<Eigen::Vector2d> obstacles;  // fixed discs of the same radius
  std::uint64_t seed = 1;
};

// Robots that drive about smoothly and never touch each other, the obstacles or the border.
// Invariants: any two discs stay at least min_gap_m() apart, robots stay inside the floor, speed
// and turn rate keep their limits and change gradually (but for an emergency stop). Only exactly
// rounded operations are used, so that the motion is the same on every machine.
class Swarm {
 public:
  // Throws std::invalid_argument when the robots do not fit on the floor.
  explicit Swarm(const SwarmOptions& options);

  const std::vector<Robot>& robots() const { return robots_; }
  double min_gap_m() const { return options_.close_passes ? 0.002 : 0.015; }

  // Time passes; dt in seconds, at most 0.01.
  void step(double dt);

 private:
  void place(std::uint64_t seed);
  void new_goal(std::size_t robot);
  bool free_at(const Eigen::Vector2d& place, std::size_t self, std::size_t placed) const;
  void drive(std::size_t robot, double dt);

  SwarmOptions options_;
  std::vector<Robot> robots_;
  std::uint64_t random_state_ = 0;
};

}  // namespace roundel
