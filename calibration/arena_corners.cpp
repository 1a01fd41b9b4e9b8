#include "calibration/arena_corners.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

namespace roundel {
namespace {

using Corners = std::array<StillMarker, 4>;

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

// Twice the area that the corners enclose; positive if they go round counter-clockwise as seen
// (the image's y runs down).
double seen_area(const Corners& corners) {
  const Eigen::Vector2d one = corners[2].ray - corners[0].ray;
  const Eigen::Vector2d other = corners[3].ray - corners[1].ray;
  return -cross(one, other);
}

bool is_convex(const Corners& corners) {
  int left = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector2d a = corners[(i + 1) % 4].ray - corners[i].ray;
    const Eigen::Vector2d b = corners[(i + 2) % 4].ray - corners[(i + 1) % 4].ray;
    left += cross(a, b) < 0 ? 1 : 0;
  }
  return left == 0 || left == 4;
}

Corners turned(const Corners& corners, std::size_t by) {
  Corners result;
  for (std::size_t i = 0; i < 4; ++i) result[i] = corners[(i + by) % 4];
  return result;
}

// Counter-clockwise as seen, and the first at the origin.
Corners in_order(Corners corners, ArenaOrigin origin) {
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (const StillMarker& corner : corners) middle += corner.ray / 4;
  std::sort(corners.begin(), corners.end(), [&](const StillMarker& a, const StillMarker& b) {
    const Eigen::Vector2d p = a.ray - middle, q = b.ray - middle;
    return std::atan2(-p.y(), p.x()) < std::atan2(-q.y(), q.x());
  });
  // The side from bottom left to bottom right is the one that runs most to the right.
  std::size_t bottom_left = 0;
  double most = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 4; ++i) {
    const Corners c = turned(corners, i);
    const Eigen::Vector2d x = c[1].ray - c[0].ray + c[2].ray - c[3].ray;
    if (x.x() / x.norm() > most) {
      most = x.x() / x.norm();
      bottom_left = i;
    }
  }
  return turned(corners, bottom_left + static_cast<std::size_t>(origin));
}

std::vector<SeenReference> placed(const Corners& corners, const ArenaRequest& request) {
  const std::array<Eigen::Vector3d, 4> places = corner_places(request);
  std::vector<SeenReference> result;
  for (std::size_t i = 0; i < 4; ++i) result.push_back({corners[i], places[i]});
  return result;
}

double worst_residual(const std::vector<SeenReference>& references) {
  const auto fit = fit_references(references);
  if (!fit) return std::numeric_limits<double>::infinity();
  double worst = 0;
  for (const Eigen::Vector2d& r : residuals(fit->arena_in_camera, references)) {
    worst = std::max(worst, r.norm());
  }
  return worst;
}

std::string places_text(std::span<const StillMarker> markers) {
  std::vector<std::string> places;
  for (const StillMarker& marker : markers) {
    const std::string name = marker.id < 0 ? "" : fmt::format("id {} ", marker.id);
    places.push_back(
        fmt::format("{}at ({:.0f}, {:.0f})", name, marker.pixel.x(), marker.pixel.y()));
  }
  return fmt::format("{}", fmt::join(places, ", "));
}

[[noreturn]] void refuse_shape(const Corners& corners, const ArenaRequest& request) {
  ArenaRequest exchanged = request;
  std::swap(exchanged.width_m, exchanged.height_m);
  const double tolerance = corner_tolerance(request);
  const auto references = placed(corners, request);
  std::string found = "can't be one at all";
  if (const auto fit = fit_references(references)) {
    std::vector<std::string> numbers;
    for (const Eigen::Vector2d& r : residuals(fit->arena_in_camera, references)) {
      numbers.push_back(fmt::format("{:.0f}", 1000 * r.norm()));
    }
    found = fmt::format("are off by {} mm ({:.0f} mm is allowed)", fmt::join(numbers, ", "),
                        1000 * tolerance);
  }
  std::array<double, 4> sides{};
  for (std::size_t i = 0; i < 4; ++i) {
    sides[i] = (corners[(i + 1) % 4].position - corners[i].position).norm();
  }
  std::string hint;
  if (worst_residual(placed(corners, exchanged)) < tolerance) {
    hint = fmt::format(
        "; {} would fit: is the origin another corner, or are width and height "
        "exchanged?",
        size_text(exchanged));
  }
  throw ArenaRefusal(fmt::format(
      "the markers {} are no rectangle of {}: the corners {}; by the markers' own size the sides "
      "are {:.2f}, {:.2f}, {:.2f} and {:.2f} m{}",
      places_text(corners), size_text(request), found, sides[0], sides[1], sides[2], sides[3],
      hint));
}

// Plain markers that are no misread ones.
std::vector<StillMarker> candidates_of(std::span<const StillMarker> still) {
  constexpr double kSamePlace = 5;  // pixels
  std::vector<StillMarker> plain, all;
  for (const StillMarker& marker : still) {
    const bool misread =
        marker.id < 0 && std::any_of(still.begin(), still.end(), [&](const StillMarker& other) {
          return other.id >= 0 && (other.pixel - marker.pixel).norm() < kSamePlace;
        });
    if (misread) continue;
    all.push_back(marker);
    if (marker.id < 0) plain.push_back(marker);
  }
  return plain.size() >= 4 ? plain : all;
}

}  // namespace

std::string size_text(const ArenaRequest& request) {
  return fmt::format("{:g} x {:g} m", request.width_m, request.height_m);
}

std::array<Eigen::Vector3d, 4> corner_places(const ArenaRequest& request) {
  const double w = request.width_m, h = request.height_m, z = request.corner_height_m;
  return {Eigen::Vector3d(0, 0, z), {w, 0, z}, {w, h, z}, {0, h, z}};
}

double corner_tolerance(const ArenaRequest& request) {
  // Six unknowns take up most of what four corners are off: what is left is about half of it.
  constexpr double kShare = 0.002, kLeast = 0.003;
  if (request.tolerance_m > 0) return request.tolerance_m;
  return std::max(kLeast, kShare * std::hypot(request.width_m, request.height_m));
}

std::optional<ArenaPoseFit> fit_references(std::span<const SeenReference> references) {
  std::vector<PlacedRay> rays;
  for (const SeenReference& reference : references) {
    rays.push_back({reference.place, reference.marker.ray, reference.marker.covariance.inverse()});
  }
  return fit_arena_pose(rays);
}

std::vector<Eigen::Vector2d> residuals(const Pose& arena_in_camera,
                                       std::span<const SeenReference> references) {
  std::vector<Eigen::Vector2d> result;
  for (const SeenReference& reference : references) {
    const auto found = on_plane(arena_in_camera, reference.marker.ray, reference.place.z());
    constexpr double kNowhere = std::numeric_limits<double>::infinity();
    result.push_back(found ? (*found - reference.place).head<2>()
                           : Eigen::Vector2d(kNowhere, kNowhere));
  }
  return result;
}

std::vector<SeenReference> outermost_corners(std::span<const StillMarker> still,
                                             const ArenaRequest& request) {
  constexpr std::size_t kMaxCandidates = 16;  // 1820 ways to choose four
  std::vector<StillMarker> candidates = candidates_of(still);
  if (candidates.size() < 4) {
    throw ArenaRefusal(fmt::format(
        "{} marker{} that could be a corner {} in view and stand{} still, four are needed{}{}",
        candidates.size(), candidates.size() == 1 ? "" : "s", candidates.size() == 1 ? "is" : "are",
        candidates.size() == 1 ? "s" : "", candidates.empty() ? "" : ": seen ",
        places_text(candidates)));
  }
  // Of too many, those farthest from the middle.
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (const StillMarker& c : candidates) middle += c.ray / static_cast<double>(candidates.size());
  std::sort(candidates.begin(), candidates.end(), [&](const StillMarker& a, const StillMarker& b) {
    return (a.ray - middle).squaredNorm() > (b.ray - middle).squaredNorm();
  });
  candidates.resize(std::min(candidates.size(), kMaxCandidates));

  const double tolerance = corner_tolerance(request);
  double largest = 0, largest_fitting = 0;
  Corners outermost;
  std::vector<SeenReference> fitting;
  const std::size_t n = candidates.size();
  for (std::size_t a = 0; a < n; ++a) {
    for (std::size_t b = a + 1; b < n; ++b) {
      for (std::size_t c = b + 1; c < n; ++c) {
        for (std::size_t d = c + 1; d < n; ++d) {
          const Corners corners = in_order(
              {candidates[a], candidates[b], candidates[c], candidates[d]}, request.origin);
          const double area = seen_area(corners);
          if (!is_convex(corners)) continue;
          if (area > largest) {
            largest = area;
            outermost = corners;
          }
          if (area <= largest_fitting) continue;
          std::vector<SeenReference> references = placed(corners, request);
          if (worst_residual(references) > tolerance) continue;
          largest_fitting = area;
          fitting = std::move(references);
        }
      }
    }
  }
  if (!fitting.empty()) return fitting;
  if (largest > 0) refuse_shape(outermost, request);
  throw ArenaRefusal(
      fmt::format("the markers {} do not enclose an arena: four of them must be "
                  "corners of a rectangle",
                  places_text(candidates)));
}

std::vector<SeenReference> named_corners(std::span<const StillMarker> still,
                                         const ArenaRequest& request) {
  const std::array<Eigen::Vector3d, 4> places = corner_places(request);
  std::vector<SeenReference> found;
  Corners corners;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto marker = std::find_if(still.begin(), still.end(), [&](const StillMarker& candidate) {
      return candidate.id == request.ids[i];
    });
    if (marker == still.end()) continue;
    corners[i] = *marker;
    found.push_back({*marker, places[i]});
  }
  if (found.size() < 4) return found;

  const auto& ids = request.ids;
  if (!is_convex(corners) || seen_area(corners) < 0) {
    Corners right = in_order(corners, ArenaOrigin::kBottomLeft);
    const auto first = std::find_if(right.begin(), right.end(),
                                    [&](const StillMarker& c) { return c.id == ids[0]; });
    std::rotate(right.begin(), first, right.end());
    throw ArenaRefusal(fmt::format(
        "the corners {}, {}, {}, {} {}; counter-clockwise as the camera sees them they are {}, {}, "
        "{}, {}",
        ids[0], ids[1], ids[2], ids[3],
        is_convex(corners) ? "go round clockwise, so that z would point into the floor"
                           : "are not named in the order around the arena",
        right[0].id, right[1].id, right[2].id, right[3].id));
  }
  if (worst_residual(found) > corner_tolerance(request)) refuse_shape(corners, request);
  return found;
}

}  // namespace roundel
