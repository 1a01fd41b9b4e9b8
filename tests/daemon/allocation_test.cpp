// The promise of DESIGN.md section 1: from the luma view to the encoded message nothing allocates.
#include <doctest/doctest.h>

#include <algorithm>
#include <span>

#include "core/tracker.hpp"
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
    GreyImage image;
    std::size_t most_markers = 0, bytes = 0;
    const auto carry = [&](std::int64_t number) {
      const std::span<const Marker> markers = tracker.track(image.view());
      for (const Bytes part : frames.encode(sample_information(number), markers)) {
        bytes += part.size();
      }
      for (const Marker* marker : poses.select(markers)) {
        bytes += poses.encode(sample_information(number), *marker).size();
      }
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
  }
}
