#include "bench/speed/measure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "bench/common/painter.hpp"
#include "bench/common/roundel_system.hpp"
#include "bench/speed/stopwatch.hpp"
#include "core/tracker.hpp"
#include "simulator/noise.hpp"
#include "simulator/random.hpp"

namespace roundel::bench {

namespace {

constexpr int kFirstEvery = 10;  // following frames a first one
constexpr int kSoon = 5;         // frames until a newcomer has to be found
constexpr int kWarmUp = 20;      // frames: memory has grown, all markers are known

// Times of one kind of frame, and how much was seen in them.
class Series {
 public:
  void add(double us, std::size_t seen, std::size_t shown) {
    us_.push_back(us);
    seen_ += seen;
    shown_ += shown;
  }
  Timing timing(const Experiment& experiment, std::string system, std::string frames,
                std::string note = {}, bool as_wanted = true) const {
    return {.scene = experiment.name,
            .system = std::move(system),
            .frames = std::move(frames),
            .width = experiment.camera.width,
            .markers = experiment.markers,
            .us = distribution_of(us_),
            .count = static_cast<int>(us_.size()),
            .seen = shown_ > 0 ? static_cast<double>(seen_) / static_cast<double>(shown_) : 1,
            .as_wanted = as_wanted,
            .note = std::move(note)};
  }

 private:
  std::vector<double> us_;
  std::size_t seen_ = 0, shown_ = 0;
};

Tracker tracker_of(const Experiment& experiment) {
  return {roundel_parameters(experiment, true), experiment.camera};
}

std::size_t with_id(std::span<const Sighting> sightings) {
  return static_cast<std::size_t>(std::count_if(sightings.begin(), sightings.end(),
                                                [](const Sighting& s) { return s.number >= 0; }));
}

struct Look {
  double us = 0;
  std::size_t seen = 0;
};
Look follow(Tracker& tracker, const GreyImage& picture) {
  Look look;
  look.us = time_of([&] { look.seen = tracker.track(picture.view()).size(); });
  return look;
}

}  // namespace

Timings time_roundel(const Experiment& experiment) {
  Painter painter(experiment, whycode_print(experiment));
  Tracker tracker = tracker_of(experiment), newcomer = tracker_of(experiment);
  Series following, first;
  GreyImage picture;
  for (int i = 0; i < std::ssize(experiment.views); ++i) {
    const View& view = experiment.views[static_cast<std::size_t>(i)];
    painter.paint(view, picture);
    const Look look = follow(tracker, picture);
    if (i >= kWarmUp) following.add(look.us, look.seen, view.markers.size());
    if (i % kFirstEvery != 0) continue;
    newcomer.reset();
    const Look fresh = follow(newcomer, picture);
    if (i > 0) first.add(fresh.us, fresh.seen, view.markers.size());
  }
  return {following.timing(experiment, "roundel", "following"),
          first.timing(experiment, "roundel", "first")};
}

Timings time_peer(const Experiment& experiment, const Contender& peer, int looks) {
  Painter painter(experiment, peer.print(experiment));
  const Systems systems = peer.systems(experiment);
  std::vector<Series> series(systems.size());
  const auto views = std::ssize(experiment.views);
  GreyImage picture;
  for (int look = -1; look < looks; ++look) {  // the first one warms up
    const View& view =
        experiment.views[static_cast<std::size_t>((look + 1) * (views - 1) / (looks + 1))];
    painter.paint(view, picture);
    for (std::size_t i = 0; i < systems.size(); ++i) {
      std::size_t seen = 0;
      const double us = time_of([&] { seen = with_id(systems[i]->look(picture.view())); });
      if (look >= 0) series[i].add(us, seen, view.markers.size());
    }
  }
  Timings timings;
  for (std::size_t i = 0; i < systems.size(); ++i) {
    timings.push_back(series[i].timing(experiment, peer.name, "any"));
  }
  return timings;
}

Timings time_empty(const Experiment& experiment) {
  Painter painter(experiment, whycode_print(experiment));
  Tracker tracker = tracker_of(experiment);
  Series series;
  GreyImage picture;
  for (int i = 0; i < std::ssize(experiment.views); ++i) {
    View view = experiment.views[static_cast<std::size_t>(i)];
    view.markers.clear();
    painter.paint(view, picture);
    const Look look = follow(tracker, picture);
    if (i >= kWarmUp) series.add(look.us, 0, 0);
  }
  return {series.timing(experiment, "roundel", "no marker")};
}

Timings time_missing(Experiment experiment) {
  Painter painter(experiment, whycode_print(experiment));
  Tracker tracker = tracker_of(experiment);
  Series series;
  const auto views = std::ssize(experiment.views);
  const auto back = views - views / 5;
  int found_after = -1;
  GreyImage picture;
  for (std::ptrdiff_t i = 0; i < views; ++i) {
    View view = experiment.views[static_cast<std::size_t>(i)];
    const bool gone = i >= kWarmUp && i < back;
    if (gone) std::erase_if(view.markers, [](const PlacedMarker& m) { return m.number == 0; });
    painter.paint(view, picture);
    const Look look = follow(tracker, picture);
    if (gone) series.add(look.us, look.seen, view.markers.size());
    if (i >= back && found_after < 0 && look.seen == view.markers.size()) {
      found_after = static_cast<int>(i - back) + 1;
    }
  }
  return {series.timing(experiment, "roundel", "one of them missing",
                        found_after < 0 ? std::string("not found again")
                                        : fmt::format("found again in frame {}", found_after),
                        found_after > 0 && found_after <= kSoon)};
}

Timings time_light_drop(const Experiment& experiment) {
  constexpr int kDrop = 4, kEvery = 20;
  Experiment silent = experiment;
  silent.imaging.noise_sigma = 0;
  Painter painter(silent, whycode_print(silent));
  const NoiseTable noise(experiment.imaging.noise_sigma, experiment.camera.width);
  Tracker tracker = tracker_of(experiment);
  Series usual, dropped;
  std::size_t kept = 0, had = 0;
  std::set<std::int64_t> before;
  GreyImage picture;
  std::vector<std::int16_t> row;
  bool dark = false;
  for (int i = 0; i < std::ssize(experiment.views); ++i) {
    const View& view = experiment.views[static_cast<std::size_t>(i)];
    painter.paint(view, picture);
    const bool drops = !dark && i >= kWarmUp && i % kEvery == 0;
    if (drops) dark = true;
    if (i % kEvery == kEvery / 2) dark = false;
    Random random(view.noise_seed);
    for (int v = 0; v < picture.height; ++v) {
      std::uint8_t* pixels = picture.pixels.data() + static_cast<std::ptrdiff_t>(v) * picture.width;
      row.clear();
      for (int u = 0; u < picture.width; ++u) {
        row.push_back(
            static_cast<std::int16_t>(pixels[u] * Response::kFixedOne / (dark ? kDrop : 1)));
      }
      noise.apply(row.data(), pixels, picture.width, random.bits());
    }
    std::span<const Marker> markers;
    const double us = time_of([&] { markers = tracker.track(picture.view()); });
    if (i >= kWarmUp) (drops ? dropped : usual).add(us, markers.size(), view.markers.size());
    std::set<std::int64_t> now;
    for (const Marker& marker : markers) now.insert(marker.track);
    if (drops) {
      had += before.size();
      kept += static_cast<std::size_t>(std::count_if(
          before.begin(), before.end(), [&](std::int64_t track) { return now.contains(track); }));
    }
    before = std::move(now);
  }
  return {usual.timing(experiment, "roundel", "before and after the light drops"),
          dropped.timing(experiment, "roundel", "light drops to a quarter",
                         fmt::format("{} of {} tracks went on", kept, had), kept == had)};
}

Timings time_jumps(Experiment experiment) {
  const double jump = 1.5 * experiment.diameter_m;
  // One scene, of which every second frame is moved aside.
  const View scene = experiment.views.front();
  Painter painter(experiment, whycode_print(experiment));
  Tracker tracker = tracker_of(experiment);
  Series series;
  GreyImage picture;
  std::size_t expected = 0;
  for (int i = 0; i < std::ssize(experiment.views); ++i) {
    View view = scene;
    view.noise_seed = experiment.views[static_cast<std::size_t>(i)].noise_seed;
    for (PlacedMarker& marker : view.markers) {
      const double inward = marker.pose.position.x() > 0 ? -1 : 1;
      if (i >= kWarmUp && i % 2 != 0) marker.pose.position.x() += inward * jump;
    }
    painter.paint(view, picture);
    const Look look = follow(tracker, picture);
    expected = view.markers.size();
    if (i >= kWarmUp) series.add(look.us, look.seen, expected);
  }
  return {series.timing(experiment, "roundel", "markers jump by 1.5 diameters")};
}

}  // namespace roundel::bench
