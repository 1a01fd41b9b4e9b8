#include "calibration/arena_calibrator.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace roundel {
namespace {

constexpr int kLeastFrames = 20;
constexpr double kLeastShare = 0.5;  // of the frames, in which a corner must have been seen
constexpr double kMaxSizeError = 0.1;

void require(bool holds, const std::string& message) {
  if (!holds) throw std::invalid_argument(message);
}

bool in_range(double value, double least, double most) {
  return value >= least && value <= most;  // false for NaN
}

// Standard deviation of positions on the floor, at the corner where it is largest.
double certainty(const ArenaPoseFit& fit, const ArenaRequest& request) {
  double worst = 0;
  for (const Eigen::Vector3d& place : corner_places(request)) {
    const Eigen::Matrix2d c = floor_covariance(fit.arena_in_camera, fit.covariance, place);
    worst = std::max(worst, std::sqrt(0.5 * c.trace()));
  }
  return worst;
}

std::string millimetres(double metres) {
  return fmt::format("{:.1f} mm", 1000 * metres);
}

}  // namespace

void check(const ArenaRequest& request) {
  require(in_range(request.width_m, 0.05, 1000) && in_range(request.height_m, 0.05, 1000),
          "width and height of the arena must be 0.05 to 1000 m");
  require(request.ids.empty() || request.ids.size() == 4,
          fmt::format("four corner ids are needed, not {}", request.ids.size()));
  require(request.anchors.size() <= 100, "at most 100 anchors are possible");
  std::set<int> ids;
  const auto take = [&](int id) {
    require(id >= 1 && id <= 65535, fmt::format("id {} does not exist", id));
    require(ids.insert(id).second, fmt::format("id {} is named twice", id));
  };
  for (const int id : request.ids) take(id);
  for (const ArenaAnchor& anchor : request.anchors) {
    take(anchor.id);
    require(in_range(anchor.x, -1000, 1000) && in_range(anchor.y, -1000, 1000),
            fmt::format("anchor {} must lie within 1000 m of the origin", anchor.id));
  }
  require(in_range(request.corner_height_m, -10, 10), "the corners' height must be -10 to 10 m");
  require(request.corner_diameter_m == 0 || in_range(request.corner_diameter_m, 0.001, 10),
          "the corners' diameter must be 0.001 to 10 m");
  require(in_range(request.certainty_m, 1e-6, 1), "the certainty must be 0.000001 to 1 m");
  require(in_range(request.time_limit_s, 0.1, 3600), "the time limit must be 0.1 to 3600 s");
  require(request.tolerance_m == 0 || in_range(request.tolerance_m, 0.0001, 10),
          "the tolerance must be 0.0001 to 10 m");
}

ArenaCalibrator::ArenaCalibrator(const ArenaRequest& request, const ArenaCamera& camera,
                                 double diameter_m)
    : request_(request), camera_(camera), diameter_m_(diameter_m), collector_(camera.intrinsics) {
  check(request_);
  if (request_.corner_diameter_m == 0) request_.corner_diameter_m = diameter_m_;
}

void ArenaCalibrator::add_anchors(const std::vector<StillMarker>& still,
                                  std::vector<SeenReference>& references) const {
  for (const ArenaAnchor& anchor : request_.anchors) {
    const auto marker = std::find_if(still.begin(), still.end(), [&](const StillMarker& candidate) {
      return candidate.id == anchor.id;
    });
    if (marker == still.end()) continue;
    references.push_back({*marker, {anchor.x, anchor.y, request_.corner_height_m}});
  }
}

// Throws ArenaRefusal unless there are enough fixed markers in the right shape.
std::vector<SeenReference> ArenaCalibrator::references() const {
  const std::vector<StillMarker> still = collector_.still_markers(kLeastShare);
  if (request_.ids.empty()) {
    std::vector<StillMarker> free;  // anchors are no corners
    std::copy_if(still.begin(), still.end(), std::back_inserter(free), [&](const StillMarker& m) {
      return std::none_of(request_.anchors.begin(), request_.anchors.end(),
                          [&](const ArenaAnchor& anchor) { return anchor.id == m.id; });
    });
    std::vector<SeenReference> result = outermost_corners(free, request_);
    add_anchors(still, result);
    return result;
  }

  std::vector<SeenReference> result = named_corners(still, request_);
  const std::size_t corners = result.size();
  add_anchors(still, result);
  if (corners == 4 || result.size() >= 4) return result;
  std::vector<std::string> missing;
  for (const int id : request_.ids) {
    if (std::any_of(result.begin(), result.end(),
                    [id](const SeenReference& r) { return r.marker.id == id; })) {
      continue;
    }
    const ArenaCollector::Sighting seen = collector_.sighting(id);
    missing.push_back(seen.twice        ? fmt::format("{} is worn by two markers", id)
                      : seen.share == 0 ? fmt::format("{} was not seen", id)
                      : seen.moves      ? fmt::format("{} does not stand still", id)
                                   : fmt::format("{} was seen in only {:.0f} % of the frames", id,
                                                 100 * seen.share));
  }
  throw ArenaRefusal(fmt::format("{} of the four corners {} in view: marker {}", corners,
                                 corners == 1 ? "is" : "are", fmt::join(missing, ", marker ")));
}

ArenaCalibrator::Progress ArenaCalibrator::progress() const {
  Progress progress;
  progress.frames = collector_.frames();
  if (progress.frames == 0) {
    progress.text = "waiting for frames";
    return progress;
  }
  try {
    const std::vector<SeenReference> found = references();
    progress.markers = found.size();
    const std::optional<ArenaPoseFit> fit = fit_references(found);
    if (!fit) {
      progress.text = "the markers do not make a plane";
      return progress;
    }
    progress.certainty_m = certainty(*fit, request_);
    progress.done =
        *progress.certainty_m <= request_.certainty_m && progress.frames >= kLeastFrames;
    progress.text =
        fmt::format("{} markers, certain to {:.2f} mm", found.size(), 1000 * *progress.certainty_m);
  } catch (const ArenaRefusal& refusal) {
    progress.text = refusal.what();
  }
  return progress;
}

// How large the arena would be by the markers' own distances, over what was said: poses of markers
// know the scale, if only to a few percent.
double ArenaCalibrator::size_by_markers(const Pose& arena_in_camera,
                                        std::span<const SeenReference> references) const {
  double sum = 0;
  for (const SeenReference& reference : references) {
    sum += reference.marker.position.z() / arena_in_camera.to_camera(reference.place).z();
  }
  const double corner_scale = request_.corner_diameter_m / diameter_m_;
  return corner_scale * sum / static_cast<double>(references.size());
}

void ArenaCalibrator::refuse_misplaced(const std::vector<ArenaReference>& references) const {
  const auto worst = std::max_element(references.begin(), references.end(),
                                      [](const ArenaReference& a, const ArenaReference& b) {
                                        return a.residual.norm() < b.residual.norm();
                                      });
  if (worst->residual.norm() <= corner_tolerance(request_)) return;
  throw ArenaRefusal(fmt::format(
      "marker {}is {} from where it should be ({} is allowed): it should be at ({:g}, {:g}), and "
      "is at ({:.3f}, {:.3f})",
      worst->id < 0 ? "" : fmt::format("{} ", worst->id), millimetres(worst->residual.norm()),
      millimetres(corner_tolerance(request_)), worst->place.x(), worst->place.y(),
      worst->place.x() + worst->residual.x(), worst->place.y() + worst->residual.y()));
}

ArenaCalibration ArenaCalibrator::result() const {
  if (collector_.frames() < kLeastFrames) {
    throw ArenaRefusal(fmt::format("only {} frames came, at least {} are needed",
                                   collector_.frames(), kLeastFrames));
  }
  const std::vector<SeenReference> found = references();
  const std::optional<ArenaPoseFit> fit = fit_references(found);
  if (!fit) throw ArenaRefusal("the markers do not make a plane; do three lie on a line?");

  ArenaCalibration result;
  result.request = request_;
  result.arena_in_camera = fit->arena_in_camera;
  result.frames = collector_.frames();
  result.camera = camera_;
  const std::vector<Eigen::Vector2d> off = residuals(fit->arena_in_camera, found);
  for (std::size_t i = 0; i < found.size(); ++i) {
    const StillMarker& marker = found[i].marker;
    result.references.push_back({marker.id, found[i].place, marker.pixel, off[i]});
  }
  refuse_misplaced(result.references);
  const std::array<Eigen::Vector3d, 4> places = corner_places(request_);
  for (std::size_t i = 0; i < 4; ++i) {
    // Of a corner that an anchor stands in for nothing is known.
    Eigen::Vector2d side = (places[(i + 1) % 4] - places[i]).head<2>();
    const double given = side.norm();
    for (std::size_t k = 0; k < found.size(); ++k) {
      if (found[k].place == places[i]) side -= off[k];
      if (found[k].place == places[(i + 1) % 4]) side += off[k];
    }
    result.side_errors[i] = side.norm() - given;
  }

  result.size_by_markers = size_by_markers(fit->arena_in_camera, found);
  if (std::abs(result.size_by_markers - 1) > kMaxSizeError) {
    throw ArenaRefusal(fmt::format(
        "the four markers make a rectangle, but by their own size ({:g} m) it is {:.2f} x {:.2f} "
        "m, not {}: is the size right, and the markers' diameter?",
        request_.corner_diameter_m, result.size_by_markers * request_.width_m,
        result.size_by_markers * request_.height_m, size_text(request_)));
  }

  result.certainty_m = certainty(*fit, request_);
  if (result.certainty_m > request_.certainty_m) {
    throw ArenaRefusal(fmt::format(
        "after {} frames the floor is only certain to {:.2f} mm, {:.2f} mm are wanted: give it "
        "more time, or ask for less",
        result.frames, 1000 * result.certainty_m, 1000 * request_.certainty_m));
  }
  // Markers that do not lie quite where they were said to be falsify more than noise does.
  const auto freedom = static_cast<double>(2 * found.size() - 6);
  result.covariance = fit->covariance * std::max(1.0, fit->chi_square / freedom);
  return result;
}

}  // namespace roundel
