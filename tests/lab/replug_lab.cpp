// USB cameras that are unplugged, damaged, silent, twins, and busy.
#include <doctest/doctest.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>

#include "daemon/capture/camera_controls.hpp"
#include "tests/lab/daemon_under_test.hpp"
#include "tests/lab/report.hpp"
#include "tests/lab/usb_camera.hpp"
#include "transport/clock.hpp"

using namespace roundel;

namespace {

constexpr int kPatienceMs = 20'000;
constexpr std::int64_t kPublishedWithinUs = 500'000, kBackWithinUs = 1'000'000;

UsbCameraDescription description(UsbFormat format, const std::string& serial = "LAB0001") {
  UsbCameraDescription camera;
  camera.formats = {format};
  camera.serial = serial;
  return camera;
}

// Receives until there is a camera that can be opened. When that was.
std::int64_t wait_for_node(DaemonUnderTest& daemon) {
  daemon.receive(kPatienceMs, [] { return std::filesystem::exists("/dev/video0"); });
  return now().mono_us;
}

// Whether so many cameras are there, with the links that udev makes.
bool links_are_there(std::size_t wanted) {
  const std::vector<CameraInformation> cameras = kernel_cameras().cameras();
  return cameras.size() == wanted &&
         std::all_of(cameras.begin(), cameras.end(),
                     [](const CameraInformation& camera) { return camera.links.size() >= 2; });
}

// Whether every picture that was published had been sent not long before: nothing old is shown
// anew.
bool pictures_are_fresh(const Film& film, const UsbCamera& camera,
                        const std::vector<DaemonUnderTest::Frame>& frames) {
  return std::all_of(frames.begin(), frames.end(), [&](const DaemonUnderTest::Frame& frame) {
    const auto match = film.match(frame.seen);
    if (!match) return true;
    // The time it was sent last may be later than this frame, if the film has come round.
    return frame.header.publish_mono - camera.sent_us(match->picture) < 500'000;
  });
}

}  // namespace

TEST_CASE("a camera that is unplugged 20 times is taken back 20 times") {
  constexpr int kCycles = 20;
  const Film& film = Film::shared();
  UsbCamera camera(film, description(UsbFormat::kGrey));
  DaemonUnderTest daemon(
      film, {"camera.controls={auto_exposure: Manual Mode, exposure_time_absolute: 50}"});
  REQUIRE(daemon.poses_arrive(kPatienceMs));
  daemon.receive(200);
  const auto lines_logged = [&] {
    const std::string& log = daemon.log();
    return std::count(log.begin(), log.end(), '\n');
  };
  const auto lines_at_start = lines_logged();
  std::int64_t worst_loss_us = 0, worst_return_us = 0, worst_plug_us = 0;
  int descriptors = 0;
  long resident_kb = 0;
  for (int cycle = 0; cycle < kCycles; ++cycle) {
    CAPTURE(cycle);
    daemon.forget();
    const std::int64_t unplugged_us = now().mono_us;
    camera.unplug();
    REQUIRE(daemon.receive(kPatienceMs, [&] {
      return daemon.published_us(header_t::CAMERA_LOST, unplugged_us).has_value();
    }));
    const std::int64_t lost_us = *daemon.published_us(header_t::CAMERA_LOST, unplugged_us);
    CHECK(lost_us - unplugged_us < kPublishedWithinUs);
    daemon.receive(50);
    const std::int64_t plugged_us = now().mono_us;
    camera.plug();
    const std::int64_t node_us = wait_for_node(daemon);
    REQUIRE(daemon.receive(kPatienceMs, [&] { return daemon.poses_us(plugged_us).has_value(); }));
    const std::int64_t back_us = *daemon.poses_us(plugged_us);
    CHECK(back_us - node_us < kBackWithinUs);
    CHECK(fault_in(daemon.frames()) == "");
    CHECK(pictures_are_fresh(film, camera, daemon.frames()));
    // Nothing was published of the time in between.
    for (const DaemonUnderTest::Frame& frame : daemon.frames()) {
      const header_t& header = frame.header;
      CHECK((header.publish_mono <= lost_us || header.capture_mono >= plugged_us));
    }
    // What a camera forgets is set again.
    CHECK(camera.exposure_mode() == 1);
    CHECK(camera.exposure_time() == 50);
    worst_loss_us = std::max(worst_loss_us, lost_us - unplugged_us);
    worst_return_us = std::max(worst_return_us, back_us - node_us);
    worst_plug_us = std::max(worst_plug_us, back_us - plugged_us);
    if (cycle == 1) {  // warmed up
      descriptors = daemon.descriptors();
      resident_kb = daemon.resident_kb();
    }
  }
  CHECK(daemon.descriptors() == descriptors);
  CHECK(daemon.resident_kb() <= resident_kb + 200);
  report(
      fmt::format("unplugged {} times: lost published within {} ms; poses back within {} ms of "
                  "the device's return ({} ms of the plug); {} descriptors before and after, {} "
                  "and {} kB resident",
                  kCycles, worst_loss_us / 1000, worst_return_us / 1000, worst_plug_us / 1000,
                  descriptors, resident_kb, daemon.resident_kb()));
  INFO(daemon.log());
  CHECK(lines_logged() - lines_at_start == 2 * kCycles);  // one at loss, one at return
}

TEST_CASE("frames that the USB damages are left out, and poses go on") {
  const Film& film = Film::shared();
  UsbCamera camera(film, description(UsbFormat::kGrey));
  DaemonUnderTest daemon(film, {});
  REQUIRE(daemon.poses_arrive(kPatienceMs));
  daemon.forget();
  for (const UsbCamera::Damage damage :
       {UsbCamera::Damage::kErrorBit, UsbCamera::Damage::kShort, UsbCamera::Damage::kStall}) {
    for (int i = 0; i < 3; ++i) {
      camera.damage_next(damage);
      daemon.receive(100);
    }
    REQUIRE(daemon.poses_arrive(kPatienceMs));
  }
  CHECK_FALSE(daemon.published_us(header_t::CAMERA_LOST, 0).has_value());
  CHECK(daemon.frames().back().header.dropped >= 6);
  CHECK(fault_in(daemon.frames()) == "");
  CHECK(pictures_are_fresh(film, camera, daemon.frames()));
}

TEST_CASE("a damaged JPEG is dropped and counted") {
  const Film& film = Film::shared();
  UsbCamera camera(film, description(UsbFormat::kJpeg));
  DaemonUnderTest daemon(film, {});
  REQUIRE(daemon.poses_arrive(kPatienceMs));
  daemon.forget();
  for (int i = 0; i < 3; ++i) {
    camera.damage_next(UsbCamera::Damage::kCorrupt);
    daemon.receive(150);
  }
  REQUIRE(daemon.poses_arrive(kPatienceMs));
  CHECK(daemon.frames().back().header.dropped >= 3);
  CHECK_FALSE(daemon.published_us(header_t::CAMERA_LOST, 0).has_value());
  for (const DaemonUnderTest::Frame& frame : daemon.frames()) CHECK(frame.seen.size() == 4);
}

TEST_CASE("a silent USB camera is lost, and back when it sends again") {
  const Film& film = Film::shared();
  UsbCamera camera(film, description(UsbFormat::kGrey));
  DaemonUnderTest daemon(film, {});
  REQUIRE(daemon.poses_arrive(kPatienceMs));
  daemon.forget();
  const std::int64_t paused_us = now().mono_us;
  camera.pause(true);
  REQUIRE(daemon.receive(kPatienceMs, [&] {
    return daemon.published_us(header_t::CAMERA_LOST, paused_us).has_value();
  }));
  CHECK(*daemon.published_us(header_t::CAMERA_LOST, paused_us) - paused_us < kPublishedWithinUs);
  daemon.receive(1000);
  const std::int64_t resumed_us = now().mono_us;
  camera.pause(false);
  REQUIRE(daemon.receive(kPatienceMs, [&] { return daemon.poses_us(resumed_us).has_value(); }));
  CHECK(*daemon.poses_us(resumed_us) - resumed_us < kBackWithinUs);
  CHECK(fault_in(daemon.frames()) == "");
}

TEST_CASE("a daemon that was stopped for a while publishes nothing old") {
  const Film& film = Film::shared();
  UsbCamera camera(film, description(UsbFormat::kGrey));
  DaemonUnderTest daemon(film, {});
  REQUIRE(daemon.poses_arrive(kPatienceMs));
  daemon.forget();
  // Every stop interrupts whatever it waits for.
  for (int i = 0; i < 20; ++i) {
    daemon.process().signal(SIGSTOP);
    daemon.receive(10);
    daemon.process().signal(SIGCONT);
    daemon.receive(10);
  }
  daemon.process().signal(SIGSTOP);
  daemon.receive(1500);
  daemon.process().signal(SIGCONT);
  REQUIRE(daemon.poses_arrive(kPatienceMs));
  const std::size_t before = daemon.statuses().size();
  REQUIRE(daemon.receive(kPatienceMs, [&] { return daemon.statuses().size() > before + 1; }));
  CHECK(daemon.statuses().back().dropped_stale >= 1);
  // Stopped in the midst of a frame: the next one comes 33 ms after this one and takes some 2 ms.
  for (int delay_us = 29'000; delay_us < 34'000; delay_us += 1'000) {
    REQUIRE(daemon.poses_arrive(kPatienceMs));
    ::usleep(static_cast<unsigned>(delay_us));
    daemon.process().signal(SIGSTOP);
    daemon.receive(1500);
    daemon.process().signal(SIGCONT);
  }
  REQUIRE(daemon.poses_arrive(kPatienceMs));
  CHECK_FALSE(daemon.published_us(header_t::CAMERA_LOST, 0).has_value());
  CHECK(fault_in(daemon.frames()) == "");
  CHECK(pictures_are_fresh(film, camera, daemon.frames()));
}

TEST_CASE("of two cameras the one that was used is taken back, never the other") {
  const Film& film = Film::shared();
  UsbCamera ours(film, description(UsbFormat::kGrey, "OURS"), 0);
  DaemonUnderTest daemon(film, {});
  REQUIRE(daemon.poses_arrive(kPatienceMs));
  UsbCamera other(film, description(UsbFormat::kGrey, "OTHER"), 1);
  daemon.receive(1000, [] { return std::filesystem::exists("/dev/video2"); });
  ours.unplug();
  daemon.receive(1500);
  CHECK(other.frames_sent() == 0);
  CHECK(daemon.statuses().back().camera_state == header_t::CAMERA_LOST);
  ours.plug();
  CHECK(daemon.poses_arrive(kPatienceMs));
  CHECK(other.frames_sent() == 0);
}

TEST_CASE("rules that fit two cameras are told with both, and a link by-id decides") {
  const Film& film = Film::shared();
  const UsbCamera first(film, description(UsbFormat::kGrey, "FIRST"), 0);
  const UsbCamera second(film, description(UsbFormat::kGrey, "SECOND"), 1);
  for (int i = 0; i < 1000 && !links_are_there(2); ++i) ::usleep(10'000);
  DaemonUnderTest early(film, {"camera.match_card=Roundel"});
  early.receive(500);
  CHECK(early.has_logged("match_card \"Roundel\" fits 2 cameras"));
  early.process().signal(SIGTERM);
  CHECK(early.process().wait(std::chrono::seconds(5)) == 0);

  std::string link;
  for (const CameraInformation& camera : kernel_cameras().cameras()) {
    if (camera.serial != "SECOND") continue;
    for (const std::string& one : camera.links) {
      if (one.find("by-id") != std::string::npos) link = one;
    }
  }
  REQUIRE_FALSE(link.empty());
  DaemonUnderTest daemon(film, {"camera.device=" + link});
  CHECK(daemon.poses_arrive(kPatienceMs));
  CHECK(daemon.has_logged("serial SECOND"));
  CHECK(first.frames_sent() == 0);

  // It is busy now for anybody else.
  DaemonUnderTest late(film, {"camera.match_serial=SECOND", "camera.name=late"});
  late.receive(2000);
  CHECK(late.has_logged("another program uses it"));
}

TEST_CASE("controls are set automatics first, and by other threads in a running camera") {
  const Film& film = Film::shared();
  const UsbCamera camera(film, description(UsbFormat::kGrey));
  // By name the time comes before the mode would allow it: dynamic framerate, then time.
  DaemonUnderTest daemon(film, {"camera.controls={exposure_time_absolute: 120, auto_exposure: 1, "
                                "exposure_dynamic_framerate: false, gain: 3}"});
  const bool poses = daemon.poses_arrive(kPatienceMs);
  INFO(daemon.log());
  REQUIRE(poses);
  CHECK(camera.exposure_mode() == 1);
  CHECK(camera.exposure_time() == 120);
  CHECK(camera.exposure_priority() == 0);
  CHECK(daemon.has_logged("gain: the camera has no such control; it has: auto_exposure"));

  CameraControls controls(kernel_cameras(), {});
  controls.attach("/dev/video0");
  CHECK(controls.set("exposure_time_absolute", "200").value == 200);
  CHECK(camera.exposure_time() == 200);
  CHECK(value_text(controls.set("auto_exposure", "Aperture Priority Mode")) ==
        "Aperture Priority Mode");
  CHECK_THROWS_AS(controls.set("exposure_time_absolute", "300"), CameraError);
  CHECK_THROWS_AS(controls.set("exposure_time_absolute", "many"), std::invalid_argument);
  CHECK(daemon.poses_arrive(kPatienceMs));
}
