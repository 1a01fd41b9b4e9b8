#include "simulator/swarm.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "simulator/random.hpp"

namespace roundel {

namespace {

constexpr double kAcceleration = 0.6;      // m/s^2
constexpr double kBraking = 2.0;           // m/s^2
constexpr double kTurnAcceleration = 8.0;  // rad/s^2
constexpr double kGoalReached = 0.10;      // metres
constexpr double kGoalPatience = 12.0;     // seconds

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

Eigen::Vector2d left_of(const Eigen::Vector2d& v) {
  return {-v.y(), v.x()};
}

// A unit vector turned by a small angle; the rational form needs no sine.
Eigen::Vector2d turned(const Eigen::Vector2d& v, double angle) {
  const double t = 0.5 * angle, scale = 1 / (1 + t * t);
  const double c = (1 - t * t) * scale, s = 2 * t * scale;
  const Eigen::Vector2d w(c * v.x() - s * v.y(), s * v.x() + c * v.y());
  return w / std::sqrt(w.squaredNorm());
}

// Speed from which a robot stops within a distance.
double stopping_speed(double distance) {
  return std::sqrt(2 * 0.8 * kAcceleration * std::max(0.0, distance));
}

}  // namespace

Swarm::Swarm(const SwarmOptions& options) : options_(options) {
  place(options.seed);
  for (std::size_t i = 0; i < robots_.size(); ++i) new_goal(i);
}

// Whether a disc at `place` keeps its distance from the border, the obstacles and the first
// `placed` robots other than `self`.
bool Swarm::free_at(const Eigen::Vector2d& place, std::size_t self, std::size_t placed) const {
  const double r = options_.radius_m;
  if (place.x() < r || place.y() < r || place.x() > options_.length_m - r ||
      place.y() > options_.width_m - r) {
    return false;
  }
  const double apart = 2 * r + min_gap_m();
  for (const Eigen::Vector2d& obstacle : options_.obstacles) {
    if ((place - obstacle).squaredNorm() < apart * apart) return false;
  }
  for (std::size_t j = 0; j < placed; ++j) {
    if (j != self && (place - robots_[j].position).squaredNorm() < apart * apart) return false;
  }
  return true;
}

void Swarm::place(std::uint64_t seed) {
  Random random(seed);
  const auto count = static_cast<std::size_t>(options_.robots);
  const double r = options_.radius_m;
  robots_.assign(count, Robot{});
  const auto anywhere = [&] {
    return Eigen::Vector2d(random.uniform(r, options_.length_m - r),
                           random.uniform(r, options_.width_m - r));
  };
  std::size_t placed = 0;
  for (; placed < count; ++placed) {
    bool found = false;
    for (int attempt = 0; attempt < 300 && !found; ++attempt) {
      robots_[placed].position = anywhere();
      found = free_at(robots_[placed].position, placed, placed);
    }
    if (!found) break;
  }
  if (placed < count) {
    // Too dense for chance: a hexagonal grid, of which a random part is taken.
    std::vector<Eigen::Vector2d> slots;
    const double pitch = 2 * r + 1.5 * min_gap_m();
    const double row_pitch = pitch * std::sqrt(0.75);
    const int rows = static_cast<int>((options_.width_m - 2 * r) / row_pitch) + 1;
    const int columns = static_cast<int>((options_.length_m - 2 * r) / pitch) + 1;
    for (int row = 0; row < rows; ++row) {
      for (int column = 0; column < columns; ++column) {
        const Eigen::Vector2d slot(r + (column + 0.5 * (row % 2)) * pitch, r + row * row_pitch);
        if (free_at(slot, 0, 0)) slots.push_back(slot);
      }
    }
    if (slots.size() < count) {
      throw std::invalid_argument(
          std::to_string(count) + " robots do not fit on the arena's floor: at most " +
          std::to_string(slots.size()) +
          " markers of this size do; take fewer robots, smaller markers or a larger arena");
    }
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t rest = slots.size() - i;
      std::swap(slots[i], slots[i + random.below(static_cast<std::uint32_t>(rest))]);
      robots_[i].position = slots[i];
    }
  }
  for (Robot& robot : robots_) {
    // A direction without sine and cosine: a point of the unit disc, normalised.
    Eigen::Vector2d d;
    do {
      d = {random.uniform(-1, 1), random.uniform(-1, 1)};
    } while (d.squaredNorm() > 1 || d.squaredNorm() < 0.01);
    robot.heading = d / std::sqrt(d.squaredNorm());
  }
  random_state_ = random.bits();
}

void Swarm::new_goal(std::size_t i) {
  Random random(random_state_);
  random_state_ = random.bits();
  Robot& robot = robots_[i];
  const double r = options_.radius_m;
  robot.goal = {random.uniform(r, options_.length_m - r), random.uniform(r, options_.width_m - r)};
  robot.goal_time_s = kGoalPatience;
  robot.seeks = options_.close_passes && robots_.size() > 1 && !robot.seeks;
  if (robot.seeks) {
    // Beyond another robot, so that the way there leads past it; then away again.
    const auto other =
        (i + 1 + random.below(static_cast<std::uint32_t>(robots_.size() - 1))) % robots_.size();
    const Eigen::Vector2d beyond = robots_[other].position - robot.position;
    robot.goal = robots_[other].position + 0.3 * beyond;
    robot.goal = robot.goal.cwiseMax(Eigen::Vector2d(r, r))
                     .cwiseMin(Eigen::Vector2d(options_.length_m - r, options_.width_m - r));
    robot.goal_time_s = 0.5 * kGoalPatience;
  }
}

void Swarm::step(double dt) {
  for (std::size_t i = 0; i < robots_.size(); ++i) drive(i, dt);
}

void Swarm::drive(std::size_t i, double dt) {
  Robot& robot = robots_[i];
  const double r = options_.radius_m;
  const double comfort = options_.close_passes ? 0.01 : 0.15;  // metres of room it likes to have

  robot.goal_time_s -= dt;
  Eigen::Vector2d wish = robot.goal - robot.position;
  if (wish.squaredNorm() < kGoalReached * kGoalReached || robot.goal_time_s <= 0) {
    new_goal(i);
    wish = robot.goal - robot.position;
  }
  wish /= std::sqrt(std::max(wish.squaredNorm(), 1e-12));

  double limit = options_.max_speed;
  // `away` points from what is near; `gap` is the room left.
  const auto avoid = [&](const Eigen::Vector2d& away, double gap) {
    const double closing = -robot.heading.dot(away);
    // The other may come as fast: each may use half of the room.
    if (closing > 0) limit = std::min(limit, stopping_speed(0.5 * gap) / std::max(closing, 0.05));
    if (gap >= comfort) return;
    const double push = 1 - std::max(0.0, gap) / comfort;
    // Out of the way and round it on one side, the same for all, so that nobody stands eye to eye.
    wish += push * (1.5 * away + 0.8 * left_of(away));
  };
  const auto avoid_disc = [&](const Eigen::Vector2d& centre) {
    const Eigen::Vector2d apart = robot.position - centre;
    const double distance = std::sqrt(apart.squaredNorm());
    const double gap = distance - 2 * r - min_gap_m();
    if (gap < 0.4) avoid(apart / distance, gap);
  };
  for (std::size_t j = 0; j < robots_.size(); ++j) {
    if (j != i) avoid_disc(robots_[j].position);
  }
  for (const Eigen::Vector2d& obstacle : options_.obstacles) avoid_disc(obstacle);
  avoid({1, 0}, robot.position.x() - r);
  avoid({-1, 0}, options_.length_m - r - robot.position.x());
  avoid({0, 1}, robot.position.y() - r);
  avoid({0, -1}, options_.width_m - r - robot.position.y());
  wish /= std::sqrt(std::max(wish.squaredNorm(), 1e-12));

  // Steering: as fast as the angle to the wish asks for, within the limits.
  const double ahead = robot.heading.dot(wish), side = cross(robot.heading, wish);
  const double angle = ahead > 0 ? side : (side >= 0 ? 2 - side : -2 - side);  // grows with it
  const double rate = std::clamp(3 * angle, -options_.max_turn_rate, options_.max_turn_rate);
  const double rate_step = kTurnAcceleration * dt;
  robot.turn_rate += std::clamp(rate - robot.turn_rate, -rate_step, rate_step);
  robot.heading = turned(robot.heading, robot.turn_rate * dt);

  const double wanted = std::min(limit, options_.max_speed * std::max(0.0, 0.2 + 0.8 * ahead));
  const double change = std::clamp(wanted - robot.speed, -kBraking * dt, kAcceleration * dt);
  robot.speed = std::max(0.0, robot.speed + change);
  const Eigen::Vector2d next = robot.position + robot.heading * (robot.speed * dt);
  if (free_at(next, i, robots_.size())) {
    robot.position = next;
  } else {
    robot.speed = 0;
  }
}

}  // namespace roundel
