#include "tests/lab/film.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "core/tracker.hpp"

namespace roundel {
namespace {

ArenaOptions arena_options() {
  ArenaOptions options;
  options.image_width = 640;
  options.image_height = 480;
  options.robots = 4;
  options.clutter = false;
  return options;
}

}  // namespace

Film::Film(int pictures) {
  Arena arena(arena_options());
  camera_ = arena.camera();
  pictures_.resize(static_cast<std::size_t>(pictures));
  for (int i = 0; i < pictures; ++i) arena.render(i, pictures_[static_cast<std::size_t>(i)]);
  Tracker tracker(DetectorParameters{}, camera_);
  direct_.resize(static_cast<std::size_t>(period()));
  // Once to warm up, once as it counts.
  for (int n = 0; n < 2 * period(); ++n) {
    const std::span<const Marker> markers = tracker.track(picture(shown(n)).view());
    direct_[static_cast<std::size_t>(n % period())].assign(markers.begin(), markers.end());
  }
}

const Film& Film::shared() {
  constexpr int kPictures = 30;
  static const Film film(kPictures);
  return film;
}

int Film::shown(std::int64_t n) const {
  const std::int64_t phase = n % period();
  return static_cast<int>(std::min(phase, period() - phase));
}

std::optional<Film::Match> Film::match(std::span<const Seen> seen) const {
  std::optional<Match> best;
  for (int n = 0; n < period(); ++n) {
    Match match{shown(n), 0, 0, 0};
    for (const Marker& marker : direct_[static_cast<std::size_t>(n)]) {
      if (marker.id < 0) continue;
      for (const Seen& other : seen) {
        if (other.id != marker.id) continue;
        const double distance = std::hypot(other.u - marker.u, other.v - marker.v);
        match.worst_px = std::max(match.worst_px, distance);
        match.mean_px += distance;
        ++match.markers;
      }
    }
    if (match.markers == 0) continue;
    match.mean_px /= match.markers;
    if (!best || match.mean_px < best->mean_px) best = match;
  }
  return best;
}

}  // namespace roundel
