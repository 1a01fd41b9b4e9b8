#include "calibration/arena_collector.hpp"

#include <algorithm>
#include <cmath>

namespace roundel {
namespace {

constexpr std::size_t kMaxPlaces = 400;    // what moves leaves one behind at every step
constexpr std::size_t kMaxSamples = 3000;  // of a place
constexpr double kStill = 0.5;             // pixels, one standard deviation
constexpr double kOutlier = 3.5;           // standard deviations
constexpr double kCentreBias = 0.003;      // pixels; what averaging does not take away
constexpr double kSameMarker = 0.25;       // of the smaller semi-axis

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Median and a standard deviation that outliers don't blow up.
struct RobustSpread {
  double middle = 0, sigma = 0;
};

RobustSpread spread(const std::vector<double>& values) {
  constexpr double kGaussian = 1.4826;  // from the median absolute deviation
  RobustSpread result;
  result.middle = median(values);
  std::vector<double> deviations;
  deviations.reserve(values.size());
  for (const double value : values) deviations.push_back(std::abs(value - result.middle));
  result.sigma = kGaussian * median(std::move(deviations));
  return result;
}

}  // namespace

ArenaCollector::Place& ArenaCollector::place_of(const Marker& marker) {
  const Eigen::Vector2d pixel(marker.u, marker.v);
  const double reach = std::max(2.0, kSameMarker * marker.ellipse.b);
  const auto known = std::find_if(places_.begin(), places_.end(), [&](const Place& place) {
    return place.id == marker.id && (marker.id >= 0 || (place.pixel - pixel).norm() < reach);
  });
  if (known != places_.end()) return *known;
  Place fresh;
  fresh.id = marker.id;
  if (places_.size() < kMaxPlaces) return places_.emplace_back(std::move(fresh));
  const auto least = std::min_element(
      places_.begin(), places_.end(),
      [](const Place& a, const Place& b) { return a.samples.size() < b.samples.size(); });
  return *least = std::move(fresh);
}

void ArenaCollector::add(std::span<const Marker> markers) {
  ++frames_;
  for (const Marker& marker : markers) {
    if (!marker.has_pose || !(marker.pose.position.z() > 0)) continue;
    Place& place = place_of(marker);
    place.pixel = {marker.u, marker.v};
    if (place.last_frame == frames_) place.twice = true;
    if (place.last_frame == frames_) continue;
    place.last_frame = frames_;
    if (place.samples.size() >= kMaxSamples) continue;
    const Eigen::Vector3d& p = marker.pose.position;
    place.samples.push_back({p.head<2>() / p.z(), p.z()});
  }
}

bool ArenaCollector::average(const Place& place, StillMarker& still) const {
  constexpr std::size_t kLeastSamples = 3;
  if (place.twice || place.samples.size() < kLeastSamples) return false;
  std::vector<double> x, y, distance;
  for (const Sample& sample : place.samples) {
    x.push_back(sample.ray.x());
    y.push_back(sample.ray.y());
    distance.push_back(sample.distance);
  }
  const double pixel = 1 / std::sqrt(camera_.fx * camera_.fy);
  const RobustSpread in_x = spread(x), in_y = spread(y);
  if (std::max(in_x.sigma, in_y.sigma) > kStill * pixel) return false;

  const double gate_x = kOutlier * std::max(in_x.sigma, kCentreBias * pixel);
  const double gate_y = kOutlier * std::max(in_y.sigma, kCentreBias * pixel);
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
  int count = 0;
  for (const Sample& sample : place.samples) {
    const Eigen::Vector2d off = sample.ray - Eigen::Vector2d(in_x.middle, in_y.middle);
    if (std::abs(off.x()) > gate_x || std::abs(off.y()) > gate_y) continue;
    sum += off;
    squares += off * off.transpose();
    ++count;
  }
  if (count < static_cast<int>(kLeastSamples)) return false;
  const Eigen::Vector2d mean = sum / count;
  still.id = place.id;
  still.ray = Eigen::Vector2d(in_x.middle, in_y.middle) + mean;
  const double bias = kCentreBias * pixel;
  still.covariance = (squares / count - mean * mean.transpose()) / (count - 1) +
                     bias * bias * Eigen::Matrix2d::Identity();
  still.pixel = camera_.to_pixel(camera_.distort(still.ray));
  still.position = median(std::move(distance)) * still.ray.homogeneous();
  still.share = static_cast<double>(count) / frames_;
  return true;
}

std::vector<StillMarker> ArenaCollector::still_markers(double least_share) const {
  std::vector<StillMarker> result;
  for (const Place& place : places_) {
    StillMarker still;
    if (average(place, still) && still.share >= least_share) result.push_back(still);
  }
  return result;
}

ArenaCollector::Sighting ArenaCollector::sighting(int id) const {
  const auto place = std::find_if(places_.begin(), places_.end(),
                                  [id](const Place& candidate) { return candidate.id == id; });
  if (place == places_.end() || frames_ == 0) return {};
  StillMarker still;
  Sighting result;
  result.share = static_cast<double>(place->samples.size()) / frames_;
  result.twice = place->twice;
  result.moves = !result.twice && !average(*place, still);
  return result;
}

}  // namespace roundel
