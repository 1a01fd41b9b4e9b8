#include "tests/lab/film.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <stdexcept>

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

void write_number(std::ofstream& file, std::int32_t number) {
  file.write(reinterpret_cast<const char*>(&number), sizeof(number));
}
std::int32_t read_number(std::ifstream& file) {
  std::int32_t number = 0;
  file.read(reinterpret_cast<char*>(&number), sizeof(number));
  return std::clamp(number, 0, 1000);
}

}  // namespace

Film Film::made(int pictures) {
  Film film;
  Arena arena(arena_options());
  film.camera_ = arena.camera();
  film.pictures_.resize(static_cast<std::size_t>(pictures));
  for (int i = 0; i < pictures; ++i) {
    arena.render(i, film.pictures_[static_cast<std::size_t>(i)]);
  }
  Tracker tracker(DetectorParameters{}, film.camera_);
  film.direct_.resize(static_cast<std::size_t>(film.period()));
  // Once to warm up, once as it counts.
  for (int n = 0; n < 2 * film.period(); ++n) {
    std::vector<Seen>& seen = film.direct_[static_cast<std::size_t>(n % film.period())];
    seen.clear();
    for (const Marker& marker : tracker.track(film.picture(film.shown(n)).view())) {
      if (marker.id > 0) seen.push_back({marker.id, marker.u, marker.v});
    }
  }
  return film;
}

// The lens is that of the arena; in the file are the pictures, then the markers of each one shown.
void Film::write(const std::string& path) const {
  std::ofstream file(path, std::ios::binary);
  write_number(file, pictures());
  for (const GreyImage& picture : pictures_) {
    file.write(reinterpret_cast<const char*>(picture.pixels.data()),
               static_cast<std::streamsize>(picture.pixels.size()));
  }
  for (const std::vector<Seen>& seen : direct_) {
    write_number(file, static_cast<int>(seen.size()));
    file.write(reinterpret_cast<const char*>(seen.data()),
               static_cast<std::streamsize>(seen.size() * sizeof(Seen)));
  }
  if (!file.flush()) throw std::runtime_error(path + " can't be written");
}

Film Film::read(const std::string& path) {
  Film film;
  const Arena arena(arena_options());
  film.camera_ = arena.camera();
  std::ifstream file(path, std::ios::binary);
  film.pictures_.resize(static_cast<std::size_t>(read_number(file)));
  for (GreyImage& picture : film.pictures_) {
    picture.resize(film.camera_.width, film.camera_.height);
    file.read(reinterpret_cast<char*>(picture.pixels.data()),
              static_cast<std::streamsize>(picture.pixels.size()));
  }
  film.direct_.resize(film.pictures_.empty() ? 0 : static_cast<std::size_t>(film.period()));
  for (std::vector<Seen>& seen : film.direct_) {
    seen.resize(static_cast<std::size_t>(read_number(file)));
    file.read(reinterpret_cast<char*>(seen.data()),
              static_cast<std::streamsize>(seen.size() * sizeof(Seen)));
  }
  if (film.pictures_.empty() || !file) throw std::runtime_error(path + " is no film");
  return film;
}

const Film& Film::shared() {
  static const Film film = [] {
    const char* const path = std::getenv("ROUNDEL_LAB_FILM");
    if (path == nullptr) throw std::runtime_error("ROUNDEL_LAB_FILM names no film");
    return read(path);
  }();
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
    for (const Seen& marker : direct_[static_cast<std::size_t>(n)]) {
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
