// bench_stages: the stages of a frame one by one, by Google Benchmark. Markers of 41 px on the
// noisy floor (bench/speed/scenes.hpp).

#include <benchmark/benchmark.h>

#include "bench/common/painter.hpp"
#include "bench/common/roundel_system.hpp"
#include "bench/speed/scenes.hpp"
#include "core/conic.hpp"
#include "core/detector.hpp"
#include "core/marker_search.hpp"
#include "core/observer.hpp"
#include "core/tracker.hpp"
#include "transport/frame_encoder.hpp"

namespace roundel::bench {
namespace {

constexpr int kMarkers = 7;

// A picture and the segments of its markers, made once.
struct Stage {
  explicit Stage(int markers, bool shown = true)
      : experiment(floor_scene(markers, 1)), parameters(roundel_parameters(experiment, true)) {
    View view = experiment.views.back();
    if (!shown) view.markers.clear();
    Painter(experiment, whycode_print(experiment)).paint(view, picture);
    MarkerSearch search(parameters);
    search.begin(picture.view());
    search.search(picture.view(), whole(), search.smallest_spacing(), 1000, segments);
  }
  Box whole() const { return {0, 0, picture.width - 1, picture.height - 1}; }

  Experiment experiment;
  DetectorParameters parameters;
  GreyImage picture;
  std::vector<Segment> segments;
};

const Stage& with_markers() {
  static const Stage stage(kMarkers);
  return stage;
}

const Stage& without_markers() {
  static const Stage stage(1, false);
  return stage;
}

// Runs a call on one segment after the other: what is measured is one call's time.
template <typename Call>
void over_segments(benchmark::State& state, const Stage& stage, Call&& call) {
  std::size_t i = 0;
  for (auto _ : state) {
    call(stage.segments[i]);
    i = (i + 1) % stage.segments.size();
  }
}

void search_whole_picture(benchmark::State& state, const Stage& stage) {
  MarkerSearch search(stage.parameters);
  std::vector<Segment> found;
  for (auto _ : state) {
    found.clear();
    search.begin(stage.picture.view());
    search.search(stage.picture.view(), stage.whole(), search.smallest_spacing(), 1000, found);
    benchmark::DoNotOptimize(found.data());
  }
}
void BM_search_without_markers(benchmark::State& state) {
  search_whole_picture(state, without_markers());
}
void BM_search_7_markers(benchmark::State& state) {
  search_whole_picture(state, with_markers());
}

void BM_levels_of_a_marker(benchmark::State& state) {
  const Stage& stage = with_markers();
  over_segments(state, stage, [&](const Segment& segment) {
    benchmark::DoNotOptimize(
        measure_levels(stage.picture.view(), segment.ellipse, stage.parameters.min_contrast));
  });
}

// From a dark pixel of the ring to the segment, tests and moments included.
void BM_segment_of_a_marker(benchmark::State& state) {
  const Stage& stage = with_markers();
  SegmentFinder finder(stage.parameters);
  over_segments(state, stage, [&](const Segment& segment) {
    constexpr double kRing = 0.8;
    const Ellipse& e = segment.ellipse;
    const int u = static_cast<int>(std::lround(e.u + kRing * e.a * std::cos(e.angle)));
    const int v = static_cast<int>(std::lround(e.v + kRing * e.a * std::sin(e.angle)));
    const int extent = static_cast<int>(4 * e.a);
    benchmark::DoNotOptimize(
        finder.examine(stage.picture.view(), u, v, segment.threshold, {extent, extent}));
  });
}

void BM_two_poses_of_an_outline(benchmark::State& state) {
  const Stage& stage = with_markers();
  over_segments(state, stage, [&](const Segment& segment) {
    const auto conic = undistorted_conic(segment.ellipse, stage.experiment.camera);
    benchmark::DoNotOptimize(circle_poses(conic.value(), 0.5 * stage.parameters.diameter_m));
  });
}

void BM_code_under_one_pose(benchmark::State& state) {
  const Stage& stage = with_markers();
  CodeReader reader(stage.parameters.bits, stage.parameters.hamming);
  const double radius_m = 0.5 * stage.parameters.diameter_m;
  over_segments(state, stage, [&](const Segment& segment) {
    const auto conic = undistorted_conic(segment.ellipse, stage.experiment.camera);
    const Pose pose = pose_from_circle(circle_poses(conic.value(), radius_m).value()[0], 0);
    benchmark::DoNotOptimize(
        reader.read(stage.picture.view(), PlaneProjection(pose, radius_m, stage.experiment.camera),
                    std::sqrt(segment.ellipse.a * segment.ellipse.b), segment.levels));
  });
}

// Everything between a segment and its poses, with nothing known from earlier frames.
void BM_observe_a_new_marker(benchmark::State& state) {
  const Stage& stage = with_markers();
  Observer observer(stage.parameters, stage.experiment.camera);
  over_segments(state, stage, [&](const Segment& segment) {
    benchmark::DoNotOptimize(observer.observe(stage.picture.view(), segment));
  });
}

void BM_detect_7_markers(benchmark::State& state) {
  const Stage& stage = with_markers();
  Detector detector(stage.parameters, stage.experiment.camera);
  for (auto _ : state) benchmark::DoNotOptimize(detector.detect(stage.picture.view()).size());
}

void BM_track(benchmark::State& state) {
  const Stage stage(static_cast<int>(state.range(0)));
  Tracker tracker(stage.parameters, stage.experiment.camera);
  for (int i = 0; i < 10; ++i) tracker.track(stage.picture.view());
  for (auto _ : state) benchmark::DoNotOptimize(tracker.track(stage.picture.view()).size());
}

void BM_encode_a_frame_message(benchmark::State& state) {
  const Stage stage(static_cast<int>(state.range(0)));
  Detector detector(stage.parameters, stage.experiment.camera);
  const auto markers = detector.detect(stage.picture.view());
  FrameEncoder encoder("ROUNDEL_FRAME", "bench", 1400);
  for (auto _ : state) benchmark::DoNotOptimize(encoder.encode({}, markers).size());
}

BENCHMARK(BM_search_without_markers)->Unit(benchmark::kMicrosecond);
BENCHMARK(BM_search_7_markers)->Unit(benchmark::kMicrosecond);
BENCHMARK(BM_levels_of_a_marker)->Unit(benchmark::kMicrosecond);
BENCHMARK(BM_segment_of_a_marker)->Unit(benchmark::kMicrosecond);
BENCHMARK(BM_two_poses_of_an_outline)->Unit(benchmark::kMicrosecond);
BENCHMARK(BM_code_under_one_pose)->Unit(benchmark::kMicrosecond);
BENCHMARK(BM_observe_a_new_marker)->Unit(benchmark::kMicrosecond);
BENCHMARK(BM_detect_7_markers)->Unit(benchmark::kMicrosecond);
BENCHMARK(BM_track)->Arg(7)->Arg(30)->Arg(100)->Unit(benchmark::kMicrosecond);
BENCHMARK(BM_encode_a_frame_message)->Arg(7)->Arg(100)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace roundel::bench

BENCHMARK_MAIN();
