#include "simulator/arena.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>

#include "core/necklace.hpp"
#include "simulator/arena_camera.hpp"
#include "simulator/clutter.hpp"
#include "simulator/random.hpp"
#include "simulator/renderer.hpp"
#include "simulator/swarm.hpp"
#include "simulator/visibility.hpp"

namespace roundel {

namespace {

constexpr double kMaxStep = 0.005;  // seconds of motion between two looks around
enum Stream : std::uint64_t { kMotion = 1, kHeights, kClutter, kNoise };

// The bar that crosses above the arena.
constexpr double kBarLength = 1.6, kBarWidth = 0.08, kBarHeight = 0.4;  // metres
constexpr double kBarSpeed = 0.25;                                      // m/s
constexpr double kBarGrey = 60;

std::vector<Eigen::Vector2d> corners_of(const ArenaOptions& o) {
  if (!o.corners) return {};
  return {{0, 0}, {o.length_m, 0}, {o.length_m, o.width_m}, {0, o.width_m}};
}

SwarmOptions swarm_options_of(const ArenaOptions& o) {
  return {.robots = o.robots,
          .length_m = o.length_m,
          .width_m = o.width_m,
          .radius_m = 0.5 * o.diameter_m * o.plate_ratio,
          .max_speed = o.max_speed,
          .max_turn_rate = o.max_turn_rate,
          .close_passes = o.close_passes,
          .obstacles = corners_of(o),
          .seed = derived_seed(o.seed, kMotion)};
}

}  // namespace

struct Arena::Impl {
  explicit Impl(const ArenaOptions& the_options);

  void go_to(std::int64_t frame);
  void put_robot(std::size_t robot);
  void put_occluder();
  void tell_truth();
  bool in_sight(std::size_t marker) const;
  double time_of(std::int64_t which) const {
    return static_cast<double>(which) / options.frame_rate;
  }

  ArenaOptions options;
  std::vector<int> worn;
  Pose arena_in_camera;
  CameraModel camera;
  std::vector<Eigen::Vector2d> corner_places;
  std::size_t corners = 0;  // how many of `markers` they are
  Swarm start, swarm;       // at frame 0; at `frame`
  Renderer renderer;

  std::int64_t frame = 0;
  std::vector<SceneMarker> markers;  // corners first, then robots
  std::vector<int> ids;              // of `markers`
  std::vector<double> heights;       // of `markers`, above the floor
  std::vector<std::size_t> order;    // of painting: by height, the highest last
  Scene scene;
  FrameTruth truth;
  std::vector<ImageOutline> discs, plates;  // of `markers`
};

Arena::Impl::Impl(const ArenaOptions& the_options)
    : options(checked(the_options)),
      worn(worn_ids(options)),
      arena_in_camera(arena_in_ceiling_camera(options)),
      camera(arena_camera(options, arena_in_camera)),
      corner_places(corners_of(options)),
      start(swarm_options_of(options)),
      swarm(start),
      renderer(camera, options.imaging) {
  const auto robots = static_cast<std::size_t>(options.robots);
  corners = corner_places.size();

  SceneMarker marker;
  marker.diameter_m = options.diameter_m;
  marker.plate_ratio = options.plate_ratio;
  marker.inner_ratio = options.inner_ratio;
  const auto wear = [&](MarkerKind kind, std::size_t which) {
    marker.kind = kind;
    int id = -1;
    if (kind == MarkerKind::WhyCode) {
      id = worn[which];
      marker.bits = options.bits;
      marker.word = *NecklaceCode(options.bits, options.hamming).word(id);
    }
    markers.push_back(marker);
    ids.push_back(id);
  };
  for (std::size_t k = 0; k < corners; ++k) {
    wear(options.corner_kind, robots + k);
    const Eigen::Vector2d& place = corner_places[k];
    markers.back().pose.position = arena_in_camera.to_camera({place.x(), place.y(), 0});
    markers.back().pose.orientation = arena_in_camera.orientation;
    heights.push_back(0);
  }
  Random random(derived_seed(options.seed, kHeights));
  for (std::size_t i = 0; i < robots; ++i) {
    wear(options.bits == 0 ? MarkerKind::WhyCon : MarkerKind::WhyCode, i);
    heights.push_back(random.uniform(options.min_height_m, options.max_height_m));
  }
  order.resize(markers.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return heights[a] < heights[b]; });

  if (options.clutter) {
    scene.clutter = arena_clutter(derived_seed(options.seed, kClutter), options.length_m,
                                  options.width_m, arena_in_camera);
  }
  if (options.occluder) {
    SceneShape bar;
    bar.outline = Outline::Rectangle;
    bar.width_m = kBarWidth;
    bar.height_m = kBarLength;
    bar.grey = kBarGrey;
    bar.pose.orientation = arena_in_camera.orientation;
    scene.occluders.push_back(bar);
  }
  scene.markers.resize(markers.size());
  truth.markers.resize(markers.size());
  discs.resize(markers.size());
  plates.resize(markers.size());
  tell_truth();
}

// Invariant: swarm, markers, scene and truth belong to `frame`.
void Arena::Impl::go_to(std::int64_t wanted) {
  if (wanted < 0) throw std::invalid_argument("frame numbers start at 0");
  if (wanted == frame) return;
  if (wanted < frame) {
    swarm = start;
    frame = 0;
  }
  const int steps = std::max(1, static_cast<int>(std::ceil(1 / (options.frame_rate * kMaxStep))));
  const double dt = 1 / (options.frame_rate * steps);
  for (; frame < wanted; ++frame) {
    for (int k = 0; k < steps; ++k) swarm.step(dt);
  }
  tell_truth();
}

void Arena::Impl::put_robot(std::size_t i) {
  const Robot& robot = swarm.robots()[i];
  SceneMarker& marker = markers[corners + i];
  const auto to_camera = [&](const Eigen::Vector3d& v) -> Eigen::Vector3d {
    return arena_in_camera.orientation * v;
  };
  marker.pose.position =
      arena_in_camera.to_camera({robot.position.x(), robot.position.y(), heights[corners + i]});
  const double heading = std::atan2(robot.heading.y(), robot.heading.x());
  marker.pose.orientation =
      with_positive_w(arena_in_camera.orientation *
                      Eigen::Quaterniond(Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ())));
  marker.velocity =
      to_camera({robot.heading.x() * robot.speed, robot.heading.y() * robot.speed, 0});
  marker.spin = to_camera({0, 0, robot.turn_rate});
}

void Arena::Impl::put_occluder() {
  if (scene.occluders.empty()) return;
  SceneShape& bar = scene.occluders.front();
  // To and fro along x, between the sides of the arena.
  const double way = std::fmod(time_of(frame) * kBarSpeed, 2 * options.length_m);
  const bool forth = way < options.length_m;
  bar.pose.position = arena_in_camera.to_camera(
      {forth ? way : 2 * options.length_m - way, 0.4 * options.width_m, kBarHeight});
  bar.velocity =
      arena_in_camera.orientation * Eigen::Vector3d(forth ? kBarSpeed : -kBarSpeed, 0, 0);
}

void Arena::Impl::tell_truth() {
  const auto robots = static_cast<std::size_t>(options.robots);
  for (std::size_t i = 0; i < robots; ++i) put_robot(i);
  put_occluder();
  for (std::size_t k = 0; k < order.size(); ++k) scene.markers[k] = markers[order[k]];

  truth.frame = frame;
  truth.time_s = time_of(frame);
  for (std::size_t i = 0; i < markers.size(); ++i) {
    const double radius = 0.5 * markers[i].diameter_m;
    discs[i] = disc_outline(camera, markers[i].pose, radius);
    plates[i] = disc_outline(camera, markers[i].pose, radius * markers[i].plate_ratio);
  }
  for (std::size_t i = 0; i < markers.size(); ++i) {
    const SceneMarker& marker = markers[i];
    MarkerTruth& t = truth.markers[i];
    t.kind = marker.kind;
    t.id = ids[i];
    t.pose = marker.pose;
    const auto pixel = camera.project(marker.pose.position);
    t.u = pixel ? pixel->x() : std::numeric_limits<double>::quiet_NaN();
    t.v = pixel ? pixel->y() : std::numeric_limits<double>::quiet_NaN();
    t.visible = pixel && in_sight(i);
    t.z = heights[i];
    if (i < corners) {
      t.x = corner_places[i].x();
      t.y = corner_places[i].y();
      t.heading = 0;
    } else {
      const Robot& robot = swarm.robots()[i - corners];
      t.x = robot.position.x();
      t.y = robot.position.y();
      t.heading = std::atan2(robot.heading.y(), robot.heading.x());
    }
  }
}

bool Arena::Impl::in_sight(std::size_t i) const {
  const double margin = 2 + 3 * options.imaging.blur_px;
  if (markers[i].pose.normal().dot(markers[i].pose.position) >= 0) return false;
  if (!inside_image(discs[i], camera.width, camera.height, margin)) return false;
  for (const SceneShape& bar : scene.occluders) {
    if (closer_than(discs[i], rectangle_outline(camera, bar.pose, bar.width_m, bar.height_m),
                    margin)) {
      return false;
    }
  }
  bool above = false;  // markers painted later cover it
  for (const std::size_t other : order) {
    if (above && closer_than(discs[i], plates[other], margin)) return false;
    above = above || other == i;
  }
  return true;
}

Arena::Arena(const ArenaOptions& options) : impl_(std::make_unique<Impl>(options)) {}
Arena::~Arena() = default;
Arena::Arena(Arena&&) noexcept = default;
Arena& Arena::operator=(Arena&&) noexcept = default;

const ArenaOptions& Arena::options() const {
  return impl_->options;
}
const CameraModel& Arena::camera() const {
  return impl_->camera;
}
const Pose& Arena::arena_in_camera() const {
  return impl_->arena_in_camera;
}

void Arena::render(std::int64_t frame, GreyImage& out) {
  impl_->go_to(frame);
  impl_->renderer.render(
      impl_->scene,
      derived_seed(derived_seed(impl_->options.seed, kNoise), static_cast<std::uint64_t>(frame)),
      out);
}

const FrameTruth& Arena::truth(std::int64_t frame) {
  impl_->go_to(frame);
  return impl_->truth;
}

double Arena::clearance_m(std::int64_t frame) {
  impl_->go_to(frame);
  const auto& all = impl_->truth.markers;
  const double plates = impl_->options.diameter_m * impl_->options.plate_ratio;
  double closest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = i + 1; j < all.size(); ++j) {
      closest = std::min(closest, std::hypot(all[i].x - all[j].x, all[i].y - all[j].y) - plates);
    }
  }
  return closest;
}

}  // namespace roundel
