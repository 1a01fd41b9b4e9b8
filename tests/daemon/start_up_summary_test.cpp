#include "daemon/start_up_summary.hpp"

#include <doctest/doctest.h>

using namespace roundel;

namespace {

constexpr double kNowS = 1'790'000'000;  // 2026-09-21T14:13:20Z

FrameInformation first_frame() {
  FrameInformation information;
  information.captured.wall_us = static_cast<std::int64_t>(kNowS * 1e6);
  information.stamp_source = StampSource::kStartOfFrame;
  information.clock = ClockState::kSynchronised;
  information.calibration = CalibrationState::kValid;
  information.arena = ArenaState::kValid;
  return information;
}

using Lines = std::vector<std::string>;

}  // namespace

TEST_CASE("the summary names camera, controls, clock, lens, arena and the poses' way") {
  Configuration values;
  values.source = SourceKind::kCamera;
  values.camera.calibration = "/etc/roundel/camera.yaml";
  values.camera.controls = {{"auto_exposure", "Manual Mode"}, {"gain", "3"}};
  values.lcm.url = "udpm://239.255.76.67:7667?ttl=1";
  ArenaCalibration arena;
  arena.request.width_m = 3;
  arena.request.height_m = 2;
  arena.certainty_m = 0.00031;
  arena.date = "2026-09-20T14:13:20Z";
  const FrameInformation information = first_frame();
  StartUpFacts facts{values, information, "C270 (/dev/video0): YUYV 1280x720"};
  facts.arena = &arena;
  facts.route = {0, "eth0", "10.0.0.7"};
  facts.lens_written_s = kNowS - 200 * 86400;
  CHECK(start_up_summary(facts) ==
        Lines{"frames: C270 (/dev/video0): YUYV 1280x720",
              "controls: auto_exposure=Manual Mode, gain=3",
              "clock: frames are stamped at their start, by the driver; wall clock synchronised",
              "markers: 0.122 m, 8 bits", "lens: /etc/roundel/camera.yaml, 200 days old",
              "arena: /var/lib/roundel/arena.yaml: 3 x 2 m, certain to 0.31 mm, "
              "2026-09-20T14:13:20Z, 24 hours old",
              "poses: ROUNDEL_FRAME on udpm://239.255.76.67:7667?ttl=1, TTL 1, by interface eth0 "
              "(10.0.0.7)"});
}

TEST_CASE("the summary says what is missing") {
  Configuration values;
  values.source = SourceKind::kCamera;
  values.detector.bits = 0;
  FrameInformation information = first_frame();
  information.calibration = CalibrationState::kNone;
  information.clock = ClockState::kFreeRunning;
  StartUpFacts facts{values, information, "C270"};
  facts.route.error = 101;
  Lines lines = start_up_summary(facts);
  REQUIRE(lines.size() == 7);
  CHECK(lines[1] == "controls: as the camera has them");
  CHECK(lines[2].ends_with("wall clock not synchronised"));
  CHECK(lines[3] == "markers: 0.122 m, without a code");
  CHECK(lines[4] == "lens: not calibrated: pixels, but no poses");
  CHECK(lines[5] == "arena: not calibrated");
  CHECK(lines[6].ends_with("TTL 0, without a route yet"));

  // A calibration of another camera is there, but not used.
  ArenaCalibration arena;
  facts.arena = &arena;
  information.arena = ArenaState::kOtherCamera;
  information.calibration = CalibrationState::kOtherResolution;
  values.camera.calibration = "camera.yaml";
  lines = start_up_summary(facts);
  CHECK(lines[4] == "lens: camera.yaml, of another resolution: pixels, but no poses");
  CHECK(lines[5].ends_with("unknown date; not used"));
}

TEST_CASE("ages are told in the unit that suits them") {
  CHECK(age(0, 59) == "0 minutes old");
  CHECK(age(0, 60) == "1 minute old");
  CHECK(age(0, 3600) == "1 hour old");
  CHECK(age(0, 47 * 3600) == "47 hours old");
  CHECK(age(0, 48 * 3600) == "2 days old");
  CHECK(age(10, 0) == "from the future (is the clock right?)");
}
