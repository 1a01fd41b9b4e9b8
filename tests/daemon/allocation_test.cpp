// The promise of DESIGN.md section 1: from the luma view to the encoded message nothing allocates.
#include <doctest/doctest.h>

#include <algorithm>
#include <span>

#include "core/tracker.hpp"
#include "daemon/arena_stage.hpp"
#include "daemon/control/latest_value.hpp"
#include "simulator/arena.hpp"
#include "tests/allocation_counter.hpp"
#include "tests/sample_markers.hpp"
#include "transport/frame_encoder.hpp"
#include "transport/pose_encoder.hpp"

using namespace roundel;

namespace {

ArenaOptions arena_with(int robots) {
  ArenaOptions options;
  options.robots = robots;
  options.corners = false;
  options.bits = 11;  // 186 ids
  if (robots > 20) {
    options.length_m = 6;
    options.width_m = 4;
    options.camera_height_m = 5;
  }
  return options;
}

// The arena where the simulator has put it.
std::shared_ptr<const TrackingContext> context_of(const Arena& arena) {
  auto calibration = std::make_shared<ArenaCalibration>();
  calibration->arena_in_camera = arena.arena_in_camera();
  calibration->camera.intrinsics = arena.camera();
  auto context = std::make_shared<TrackingContext>();
  context->camera = arena.camera();
  context->calibration = std::move(calibration);
  return context;
}

}  // namespace

TEST_CASE("from the luma view to the encoded message nothing allocates after warm-up") {
  constexpr std::int64_t kFrames = 25;
  for (const int robots : {1, 12, 100}) {
    CAPTURE(robots);
    Arena arena(arena_with(robots));
    DetectorParameters parameters;
    parameters.bits = arena.options().bits;
    Tracker tracker(parameters, arena.camera());
    FrameEncoder frames("ROUNDEL_FRAME", "camera", 1400);
    PoseEncoder poses("ROUNDEL");
    ArenaStage stage;
    stage.configure(context_of(arena), {});
    LatestValue<FrameSnapshot> snapshots;
    GreyImage image;
    std::size_t most_markers = 0, bytes = 0, located = 0;
    const auto carry = [&](std::int64_t number) {
      const std::span<const Marker> markers = tracker.track(image.view());
      const std::span<const ArenaPose> places = stage.locate(markers);
      located += places.size();
      for (const Bytes part : frames.encode(sample_information(number), markers, places)) {
        bytes += part.size();
      }
      for (const Marker* marker : poses.select(markers)) {
        bytes += poses.encode(sample_information(number), *marker).size();
      }
      FrameSnapshot& snapshot = snapshots.back();
      snapshot.markers.assign(markers.begin(), markers.end());
      snapshot.arena.assign(places.begin(), places.end());
      snapshot.context = stage.context();
      snapshots.publish();
      most_markers = std::max(most_markers, markers.size());
    };
    // Warm-up sees every frame once, so that all buffers have grown to what such frames need.
    for (std::int64_t number = 0; number < kFrames; ++number) {
      arena.render(number, image);
      carry(number);
    }
    tracker.reset();
    long allocations = 0;
    for (std::int64_t number = 0; number < kFrames; ++number) {
      arena.render(number, image);
      const AllocationCounter counter;
      carry(number);
      allocations += counter.count();
    }
    CHECK(most_markers >= static_cast<std::size_t>(robots) * 9 / 10);
    CHECK(allocations == 0);
    CHECK(bytes > 0);
    CHECK(located > 0);
  }
}
