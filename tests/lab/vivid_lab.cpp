// Faults that the vivid driver injects, and formats that only it has.
#include <doctest/doctest.h>
#include <fmt/format.h>
#include <linux/videodev2.h>

#include <algorithm>

#include "daemon/capture/pixel_format.hpp"
#include "tests/lab/daemon_under_test.hpp"
#include "tests/lab/report.hpp"
#include "tests/lab/vivid_camera.hpp"
#include "transport/clock.hpp"

using namespace roundel;

namespace {

constexpr int kPatienceMs = 20'000;
constexpr int kPublishedWithinUs = 500'000, kBackWithinUs = 1'000'000;

std::vector<std::string> settings(const char* format) {
  return {std::string("camera.format=") + format, "camera.width=640", "camera.height=480",
          "camera.match_card=vivid", "camera.frame_rate=60"};
}

std::int64_t dropped(const DaemonUnderTest& daemon) {
  return daemon.frames().back().header.dropped;
}

bool ever_lost(const DaemonUnderTest& daemon) {
  return daemon.published_us(header_t::CAMERA_LOST, 0).has_value();
}

// The camera fails at start_us and is whole again at end_us (nothing: by itself, at once).
void check_loss_and_return(DaemonUnderTest& daemon, const char* fault, std::int64_t start_us,
                           std::optional<std::int64_t> end_us) {
  const auto lost_us = daemon.published_us(header_t::CAMERA_LOST, start_us);
  REQUIRE(lost_us.has_value());
  CHECK(*lost_us - start_us < kPublishedWithinUs);
  const std::int64_t whole_us = end_us.value_or(*lost_us);
  daemon.receive(kPatienceMs, [&] { return daemon.poses_us(whole_us).has_value(); });
  const auto back_us = daemon.poses_us(whole_us);
  REQUIRE(back_us.has_value());
  CHECK(*back_us - whole_us < kBackWithinUs);
  CHECK(fault_in(daemon.frames()) == "");
  report(fmt::format("vivid, {}: lost published after {} ms, poses back {} ms after {}", fault,
                     (*lost_us - start_us) / 1000, (*back_us - whole_us) / 1000,
                     end_us ? "the fault ended" : "that"));
}

void fail(DaemonUnderTest& daemon, const VividCamera& camera, const char* control) {
  REQUIRE(daemon.poses_arrive(kPatienceMs));
  daemon.receive(300);  // a fault may have an echo
  daemon.forget();
  const std::int64_t start_us = now().mono_us;
  camera.set(control, 1);
  daemon.receive(kPatienceMs,
                 [&] { return daemon.published_us(header_t::CAMERA_LOST, start_us).has_value(); });
  check_loss_and_return(daemon, control, start_us, std::nullopt);
}

}  // namespace

// One after another on one daemon: it is to stand all of them.
TEST_CASE("roundeld stands every fault that vivid can inject") {
  const Film& film = Film::shared();
  VividCamera camera(film, V4L2_PIX_FMT_GREY);
  DaemonUnderTest daemon(film, settings("GREY"));
  const bool poses = daemon.poses_arrive(kPatienceMs);
  INFO(daemon.log());
  REQUIRE(poses);
  const int descriptors = daemon.descriptors();

  // Damaged buffers are left out and counted, and poses go on.
  daemon.forget();
  REQUIRE(daemon.receive(kPatienceMs, [&] { return !daemon.frames().empty(); }));
  std::int64_t before = dropped(daemon);
  for (int i = 0; i < 100 && dropped(daemon) < before + 3; ++i) {  // the output takes some of them
    camera.set("inject_v4l2_buf_flag_error", 1);
    daemon.receive(50);
  }
  CHECK(dropped(daemon) >= before + 3);
  // Buffers that the driver refuses are given back later; these are more than there are.
  for (int i = 0; i < 6; ++i) {
    camera.set("inject_vidioc_qbuf_error", 1);
    daemon.receive(50);
  }
  REQUIRE(daemon.poses_arrive(kPatienceMs));
  // Gaps in the driver's numbers are drops.
  before = dropped(daemon);
  camera.set("percentage_of_dropped_buffers", 30);
  daemon.receive(1000);
  camera.set("percentage_of_dropped_buffers", 0);
  CHECK(dropped(daemon) > before + 8);
  CHECK_FALSE(ever_lost(daemon));
  CHECK(fault_in(daemon.frames()) == "");

  // A stream that breaks is started again, also if that fails at first.
  fail(daemon, camera, "inject_fatal_streaming_error");
  camera.set("inject_vidioc_reqbufs_error", 1);
  fail(daemon, camera, "inject_fatal_streaming_error");
  camera.set("inject_vidioc_streamon_error", 1);
  fail(daemon, camera, "inject_fatal_streaming_error");
  fail(daemon, camera, "disconnect");
  CHECK(daemon.descriptors() == descriptors);

  // A silent camera is lost, and back with its first frame.
  daemon.forget();
  const std::int64_t start_us = now().mono_us;
  camera.set("percentage_of_dropped_buffers", 100);
  daemon.receive(1500);
  const std::int64_t end_us = now().mono_us;
  camera.set("percentage_of_dropped_buffers", 0);
  check_loss_and_return(daemon, "no frames", start_us, end_us);

  // A signal that changes is another picture: the stream is started anew.
  daemon.forget();
  const std::int64_t changed_us = now().mono_us;
  camera.set("dv_timings_signal_mode", 1);  // none
  daemon.receive(500);
  const std::int64_t restored_us = now().mono_us;
  camera.set("dv_timings_signal_mode", 0);
  check_loss_and_return(daemon, "no signal", changed_us, restored_us);
  CHECK(daemon.has_logged("its picture format has changed"));

  // Numbers and stamps that wrap do no harm. They begin with the next stream.
  camera.set("wrap_sequence_number", 1);
  camera.set("wrap_timestamp", 2);
  fail(daemon, camera, "inject_fatal_streaming_error");
  daemon.forget();
  REQUIRE(daemon.receive(kPatienceMs, [&] { return daemon.frames().size() > 150; }));
  CHECK(fault_in(daemon.frames()) == "");
  CHECK_FALSE(ever_lost(daemon));
  CHECK(daemon.frames().back().header.dropped - daemon.frames().front().header.dropped < 100);
  CHECK(daemon.frames().front().header.stamp_source == header_t::STAMP_ARRIVAL);
  CHECK(daemon.process().wait(std::chrono::milliseconds(0)) == std::nullopt);
}

TEST_CASE("time stamps in the future are refused") {
  const Film& film = Film::shared();
  VividCamera camera(film, V4L2_PIX_FMT_GREY);
  camera.set("timestamp_source", 0);
  DaemonUnderTest daemon(film, settings("GREY"));
  REQUIRE(daemon.poses_arrive(kPatienceMs));
  CHECK(fault_in(daemon.frames()) == "");
}

TEST_CASE("grey of 10, 12 and 16 bits comes through vivid's loop as it was") {
  const Film& film = Film::shared();
  for (const std::uint32_t fourcc : {V4L2_PIX_FMT_Y10, V4L2_PIX_FMT_Y12, V4L2_PIX_FMT_Y16}) {
    const std::string name = fourcc_name(fourcc);
    CAPTURE(name);
    VividCamera camera(film, fourcc, "allocators=1 cache_hints=1");
    DaemonUnderTest daemon(film, settings(name.c_str()));
    REQUIRE(daemon.poses_arrive(kPatienceMs));
    daemon.forget();
    REQUIRE(daemon.receive(kPatienceMs, [&] { return daemon.frames().size() >= 40; }));
    CHECK(daemon.has_logged("cached buffers"));
    double worst_px = 0;
    for (const DaemonUnderTest::Frame& frame : daemon.frames()) {
      const auto match = film.match(frame.seen);
      REQUIRE(match.has_value());
      worst_px = std::max(worst_px, match->worst_px);
    }
    // Pictures repeat, so the tracker comes to them another way.
    CHECK(worst_px < 0.05);
    report(fmt::format("{} by vivid: off by {:.2g} px at worst in {} frames", name, worst_px,
                       daemon.frames().size()));
  }
}
