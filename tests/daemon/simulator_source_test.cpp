#include "daemon/simulator_source.hpp"

#include <doctest/doctest.h>

#include <cstdlib>

#include "tests/daemon/wait_for_descriptor.hpp"
#include "transport/clock.hpp"

using namespace roundel;

namespace {

constexpr int kTimeoutMs = 10000;

ArenaOptions small_arena(double frame_rate) {
  ArenaOptions options;
  options.image_width = 320;
  options.image_height = 180;
  options.frame_rate = frame_rate;
  options.robots = 1;
  options.clutter = false;
  return options;
}

}  // namespace

TEST_CASE("simulated frames come at their rate, numbered, with the time they show") {
  SimulatorSource source(small_arena(200));
  CHECK(source.state() == CameraState::kStarting);
  CHECK(source.simulated());
  CHECK(source.camera()->width == 320);
  std::int64_t first_us = 0, taken = 0, last = -1;
  while (taken < 10) {
    REQUIRE(wait_for_descriptor(source.descriptor(), kTimeoutMs));
    const auto lease = source.next();
    if (!lease) continue;
    const CapturedFrame& frame = lease->frame();
    REQUIRE(frame.number > last);
    CHECK(frame.luma.width == 320);
    CHECK(frame.luma.height == 180);
    CHECK(frame.stamp_source == StampSource::kMiddleOfExposure);
    CHECK(frame.captured.mono_us <= now().mono_us);
    if (taken == 0) first_us = frame.captured.mono_us - 5000 * frame.number;
    CHECK(std::abs(frame.captured.mono_us - first_us - 5000 * frame.number) <= 1);
    last = frame.number;
    ++taken;
  }
  CHECK(source.state() == CameraState::kStreaming);
  CHECK(source.dropped() == last + 1 - taken);
}

TEST_CASE("frames that nobody took in time are left out and counted; the newest wins") {
  SimulatorSource source(small_arena(1000));
  REQUIRE(wait_for_descriptor(source.descriptor(), kTimeoutMs));
  REQUIRE(source.next().has_value());
  MonotonicTimer later;
  later.arm(monotonic_ns() + 50'000'000);
  REQUIRE(wait_for_descriptor(later.descriptor(), kTimeoutMs));
  const auto lease = source.next();
  REQUIRE(lease.has_value());
  CHECK(lease->frame().number >= 50);
  CHECK(source.dropped() == lease->frame().number - 1);
}

TEST_CASE("before its time there is no frame") {
  SimulatorSource source(small_arena(0.1));
  REQUIRE(wait_for_descriptor(source.descriptor(), kTimeoutMs));
  REQUIRE(source.next().has_value());
  CHECK_FALSE(source.next().has_value());
}

TEST_CASE("an arena that can't be is refused") {
  ArenaOptions options = small_arena(30);
  options.robots = 400;
  CHECK_THROWS_AS(SimulatorSource{options}, std::invalid_argument);
}
