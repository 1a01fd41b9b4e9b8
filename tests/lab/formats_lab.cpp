// What a camera shows is what roundeld publishes, whatever the format.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>

#include "tests/lab/daemon_under_test.hpp"
#include "tests/lab/film.hpp"
#include "tests/lab/report.hpp"
#include "tests/lab/usb_camera.hpp"

using namespace roundel;

namespace {

constexpr int kPatienceMs = 20'000;
constexpr std::size_t kFrames = 60;

struct Difference {
  double worst_px = 0, mean_px = 0;
  int markers = 0;
  std::int64_t oldest_us = 0;  // a picture's age when it was published
};

Difference compare(const Film& film, const UsbCamera& camera,
                   const std::vector<DaemonUnderTest::Frame>& frames) {
  Difference difference;
  for (const DaemonUnderTest::Frame& frame : frames) {
    const auto match = film.match(frame.seen);
    if (!match) continue;
    difference.worst_px = std::max(difference.worst_px, match->worst_px);
    difference.mean_px += match->mean_px * match->markers;
    difference.markers += match->markers;
    // sent_us() is the latest time: exact as long as the film has not come round again.
    difference.oldest_us =
        std::max(difference.oldest_us, frame.header.publish_mono - camera.sent_us(match->picture));
  }
  if (difference.markers > 0) difference.mean_px /= difference.markers;
  return difference;
}

}  // namespace

TEST_CASE("simulated frames come through a USB camera to LCM as they were") {
  const Film& film = Film::shared();
  struct Case {
    const char* name;
    UsbFormat format;
    double limit_px;
  };
  // JPEG loses something, at quality 95 little.
  for (const Case& c :
       {Case{"GREY", UsbFormat::kGrey, 0.02}, Case{"YUYV", UsbFormat::kYuyv, 0.02},
        Case{"NV12", UsbFormat::kNv12, 0.02}, Case{"MJPG", UsbFormat::kJpeg, 0.2}}) {
    CAPTURE(c.name);
    UsbCameraDescription description;
    description.formats = {c.format};
    UsbCamera camera(film, description);
    DaemonUnderTest daemon(film, {});
    REQUIRE(daemon.poses_arrive(kPatienceMs));
    daemon.forget();
    REQUIRE(daemon.receive(kPatienceMs, [&] { return daemon.frames().size() >= kFrames; }));
    INFO(daemon.log());
    const Difference difference = compare(film, camera, daemon.frames());
    CHECK(difference.markers > 4 * static_cast<int>(kFrames) * 95 / 100);
    CHECK(difference.worst_px < c.limit_px);
    CHECK(fault_in(daemon.frames()) == "");
    CHECK(daemon.has_logged(std::string(": ") + c.name + " 640x480"));
    const status_t& status = daemon.statuses().back();
    report(
        fmt::format("{}: {} markers in {} frames, off by {:.2g} px on average, {:.2g} at worst; "
                    "{:.1f} frames/s, {} dropped",
                    c.name, difference.markers, daemon.frames().size(), difference.mean_px,
                    difference.worst_px, status.frame_rate, status.dropped));
    const auto percentiles = [](const latency_t& latency) {
      return fmt::format("{:.0f}/{:.0f}/{:.0f}", latency.p50, latency.p90, latency.p99);
    };
    report(fmt::format(
        "{}: us at 50/90/99 %: reading {}, tracking {}, publishing {}, dequeue to "
        "publish {}, capture to publish {}",
        c.name, percentiles(status.reading), percentiles(status.tracking),
        percentiles(status.publishing), percentiles(status.handling), percentiles(status.total)));
    CHECK(status.handling.p50 >= status.tracking.p50);
    CHECK(status.total.p99 >= status.handling.p99);
  }
}

TEST_CASE("a format that roundeld can't read comes through libv4l2, with a warning") {
  const Film& film = Film::shared();
  UsbCameraDescription description;
  description.formats = {UsbFormat::kBgr};
  UsbCamera camera(film, description);
  DaemonUnderTest daemon(film, {});
  REQUIRE(daemon.poses_arrive(kPatienceMs));
  CHECK(daemon.has_logged("libv4l2 converts every frame to"));
  daemon.forget();
  REQUIRE(daemon.receive(kPatienceMs, [&] { return daemon.frames().size() >= kFrames; }));
  const Difference difference = compare(film, camera, daemon.frames());
  // Its conversion squeezes the range of grey levels.
  CHECK(difference.worst_px < 0.2);
  report(fmt::format("BGR3 by libv4l2: off by {:.2g} px on average, {:.2g} at worst",
                     difference.mean_px, difference.worst_px));
}
