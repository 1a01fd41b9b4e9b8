// The tracker on the simulated arena, held against its truth. The same by the programs:
//   roundel simulate --frames 1000 --camera-out camera.yaml --truth truth.jsonl -o - |
//     roundel track --camera camera.yaml --json - |
//     roundel compare --truth truth.jsonl --min-found 99.9 --max-wrong 0 --max-swaps 0 -

#include <doctest/doctest.h>

#include <algorithm>
#include <limits>

#include "core/tracker.hpp"
#include "simulator/arena.hpp"
#include "tests/slow_build.hpp"
#include "tools/comparison_output.hpp"
#include "tools/track_statistics.hpp"

namespace roundel {
namespace {

using test::kSlow;

ArenaOptions arena_of(int robots) {
  ArenaOptions options;  // Full HD, four plain corner markers, a floor full of clutter
  options.robots = robots;
  options.imaging.noise_sigma = 3;
  options.imaging.blur_px = 0.7;
  return options;
}

struct Tracking {
  TrackStatistics statistics;
  double closest_m = std::numeric_limits<double>::infinity();  // of two plates
};

Tracking track(const ArenaOptions& options, std::int64_t frames) {
  Arena arena(options);
  DetectorParameters parameters;
  parameters.bits = options.bits;
  parameters.diameter_m = options.diameter_m;
  Tracker tracker(parameters, arena.camera());
  Tracking result;
  GreyImage image;
  for (std::int64_t frame = 0; frame < frames; ++frame) {
    arena.render(frame, image);
    result.statistics.add(arena.truth(frame), tracker.track(image.view()));
    result.closest_m = std::min(result.closest_m, arena.clearance_m(frame));
  }
  return result;
}

double share(std::int64_t part, std::int64_t whole) {
  return static_cast<double>(part) / static_cast<double>(whole);
}

void check_names(const TrackStatistics& statistics) {
  CHECK(statistics.late_wrong_ids() == 0);
  CHECK(statistics.not_in_truth_with_id() == 0);
  CHECK(statistics.has_tracks());
  CHECK(statistics.swaps() == 0);
}

}  // namespace

TEST_CASE("twelve robots: all visible markers in 99.9 % of frames, no wrong id, no swap") {
  const std::int64_t frames = kSlow ? 150 : 1000;
  const TrackStatistics statistics = track(arena_of(12), frames).statistics;
  INFO(comparison_text(statistics));
  REQUIRE(statistics.frames() == frames);
  CHECK(share(statistics.visible(), frames) > 15);  // of 16: hardly any hides another
  CHECK(share(statistics.complete_frames(), frames) >= 0.999);
  CHECK(statistics.least_found_share().value_or(0) >= 0.999);
  check_names(statistics);
  // An id is there from the first frames on: unnamed robots would be no wrong ids either.
  CHECK(share(statistics.coded().missing_ids, statistics.coded().found) < 0.001);
  CHECK(statistics.coded().flips == 0);
}

TEST_CASE("twenty robots that pass each other within millimetres keep their ids and tracks") {
  const std::int64_t frames = kSlow ? 100 : 400;
  ArenaOptions options = arena_of(20);
  options.close_passes = true;
  const Tracking result = track(options, frames);
  INFO(comparison_text(result.statistics));
  CHECK(result.closest_m < 0.005);
  CHECK(share(result.statistics.visible(), frames) > 20);  // of 24
  CHECK(share(result.statistics.found(), result.statistics.visible()) >= 0.999);
  check_names(result.statistics);
  CHECK(share(result.statistics.coded().missing_ids, result.statistics.coded().found) < 0.001);
}

}  // namespace roundel
