#include "calibration/arena_watch.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "calibration/arena_pose_fit.hpp"

namespace roundel {
namespace {

constexpr std::int64_t kWindowUs = 2'000'000;
constexpr int kLeastFrames = 5;
constexpr std::size_t kMostFrames = 1000;
constexpr int kWindowsToBelieve = 2;
constexpr double kLeastShare = 0.5;    // of a window's frames
constexpr double kLeastLimit = 0.003;  // metres; warmth alone moves a camera by a millimetre
constexpr double kLimitShare = 0.001;  // of the diagonal
constexpr double kReachShare = 0.4;    // of the smallest distance between two fixed markers
constexpr double kStill = 0.002;       // metres, spread within a window

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

Eigen::Vector2d median_of(const std::vector<Eigen::Vector2d>& points) {
  std::vector<double> x, y;
  for (const Eigen::Vector2d& p : points) {
    x.push_back(p.x());
    y.push_back(p.y());
  }
  return {median(x), median(y)};
}

bool stands_still(const std::vector<Eigen::Vector2d>& points, const Eigen::Vector2d& middle) {
  std::vector<double> distances;
  distances.reserve(points.size());
  for (const Eigen::Vector2d& p : points) distances.push_back((p - middle).norm());
  return median(distances) < kStill;
}

}  // namespace

ArenaWatch::ArenaWatch(const ArenaCalibration& calibration)
    : arena_in_camera_(calibration.arena_in_camera),
      limit_m_(std::max(
          {kLeastLimit, 5 * calibration.certainty_m,
           kLimitShare * std::hypot(calibration.request.width_m, calibration.request.height_m)})) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const ArenaReference& reference : calibration.references) {
    Watched watched;
    watched.id = reference.id;
    watched.name = reference.id >= 0 ? fmt::format("marker {}", reference.id)
                                     : fmt::format("the corner at ({:g}, {:g})",
                                                   reference.place.x(), reference.place.y());
    // Where it was found, not where it should be: residuals are no motion.
    watched.place = reference.place;
    watched.place.head<2>() += reference.residual;
    watched.pixel = reference.pixel;
    for (const Watched& other : watched_) {
      nearest = std::min(nearest, (other.pixel - watched.pixel).norm());
    }
    watched_.push_back(std::move(watched));
  }
  reach_px_ = kReachShare * nearest;
}

// A plain marker is the nearest one around; an id is known wherever it is.
const Marker* ArenaWatch::find(const Watched& watched, std::span<const Marker> markers) const {
  const Marker* best = nullptr;
  double nearest = watched.id >= 0 ? std::numeric_limits<double>::infinity() : reach_px_;
  for (const Marker& marker : markers) {
    if (marker.id != watched.id || !marker.has_pose || !(marker.pose.position.z() > 0)) continue;
    const double distance = (Eigen::Vector2d(marker.u, marker.v) - watched.pixel).norm();
    if (distance >= nearest) continue;
    nearest = distance;
    best = &marker;
  }
  return best;
}

bool ArenaWatch::add(std::span<const Marker> markers, std::int64_t time_us) {
  if (window_start_us_ < 0) window_start_us_ = time_us;
  ++frames_;
  for (Watched& watched : watched_) {
    const Marker* marker = find(watched, markers);
    if (marker == nullptr || watched.offsets.size() >= kMostFrames) continue;
    const Eigen::Vector3d& p = marker->pose.position;
    const auto found = on_plane(arena_in_camera_, p.head<2>() / p.z(), watched.place.z());
    if (found) watched.offsets.emplace_back((*found - watched.place).head<2>());
  }
  if (time_us - window_start_us_ < kWindowUs || frames_ < kLeastFrames) return false;
  judge();
  window_start_us_ = time_us;
  frames_ = 0;
  for (Watched& watched : watched_) watched.offsets.clear();
  return true;
}

void ArenaWatch::judge() {
  std::size_t seen = 0;
  std::vector<std::string> moved;
  const double needed = kLeastShare * static_cast<double>(std::min<std::size_t>(
                                          static_cast<std::size_t>(frames_), kMostFrames));
  for (const Watched& watched : watched_) {
    if (static_cast<double>(watched.offsets.size()) < needed) continue;
    const Eigen::Vector2d offset = median_of(watched.offsets);
    if (!stands_still(watched.offsets, offset)) continue;
    ++seen;
    if (offset.norm() <= limit_m_) continue;
    moved.push_back(fmt::format("{} by {:.0f} mm", watched.name, 1000 * offset.norm()));
  }
  const bool elsewhere = !moved.empty();
  windows_moved_ = elsewhere ? windows_moved_ + 1 : 0;
  if (elsewhere && windows_moved_ < kWindowsToBelieve) return;
  if (seen == 0) {
    // Nothing speaks against what was known before.
    if (state_ == State::kInPlace) state_ = State::kUnknown;
    if (state_ == State::kUnknown) text_ = "none of the arena's fixed markers is in view";
  } else if (!elsewhere) {
    state_ = State::kInPlace;
    text_ =
        fmt::format("{} of {} fixed markers are in view, in their places", seen, watched_.size());
  } else if (2 * moved.size() > seen && moved.size() >= 2) {
    state_ = State::kCameraMoved;
    text_ = fmt::format("the camera has been moved: it sees {}", fmt::join(moved, ", "));
  } else {
    state_ = State::kCornerMoved;
    text_ = fmt::format("a fixed marker is not in its place: {}", fmt::join(moved, ", "));
  }
}

}  // namespace roundel
