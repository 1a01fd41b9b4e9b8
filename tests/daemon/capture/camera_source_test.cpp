#include "daemon/capture/camera_source.hpp"

#include <doctest/doctest.h>
#include <linux/videodev2.h>

#include <cerrno>

#include "tests/allocation_counter.hpp"
#include "tests/daemon/capture/camera_rig.hpp"
#include "transport/clock.hpp"

using namespace roundel;

TEST_CASE("a frame is lent where the driver put it, and goes back when it is done with") {
  FakeCamera camera;
  CameraSource source({}, camera);
  CHECK(source.state() == CameraState::kStarting);
  open(source, camera);
  camera.deliver({.sequence = 7, .fill = 42});
  auto lease = wait_for_frame(source);
  REQUIRE(lease.has_value());
  CHECK(source.state() == CameraState::kStreaming);
  const CapturedFrame& frame = lease->frame();
  CHECK(frame.luma.data == camera.state().memory[0].data());
  CHECK(frame.luma.width == 64);
  CHECK(frame.luma.height == 48);
  CHECK(frame.luma.at(63, 47) == 42);
  CHECK(frame.number == 0);
  CHECK(frame.stamp_source == StampSource::kEndOfFrame);
  CHECK(camera.state().queued.size() == 3);
  lease->give_back();
  CHECK(camera.state().queued.size() == 4);
}

TEST_CASE("the newest of several frames is taken, the others go back at once and are counted") {
  FakeCamera camera;
  CameraSource source({}, camera);
  open(source, camera);
  for (std::uint32_t i = 0; i < 3; ++i) camera.deliver({.sequence = i, .fill = 1});
  auto lease = wait_for_frame(source);
  REQUIRE(lease.has_value());
  CHECK(lease->frame().number == 2);
  CHECK(source.dropped() == 2);
  CHECK(source.drops().newer == 2);
  CHECK(camera.state().queued.size() == 3);
}

TEST_CASE("numbers that the driver leaves out are drops, also where its numbers wrap") {
  FakeCamera camera;
  CameraSource source({}, camera);
  open(source, camera);
  camera.deliver({.sequence = 0xffff'fffe});
  REQUIRE(wait_for_frame(source).has_value());
  camera.deliver({.sequence = 1});  // after ..ff and 0
  auto lease = wait_for_frame(source);
  REQUIRE(lease.has_value());
  CHECK(lease->frame().number == 3);
  CHECK(source.drops().lost == 2);
  lease->give_back();

  // Repeated, backward and absurd numbers are no gaps.
  for (const std::uint32_t sequence : {1U, 0U, 0x8000'0000U}) {
    const std::int64_t before = source.dropped();
    camera.deliver({.sequence = sequence});
    REQUIRE(wait_for_frame(source).has_value());
    CHECK(source.dropped() == before);
  }
}

TEST_CASE("frames that the driver marks, or that are too short, are left out and counted") {
  FakeCamera camera;
  CameraSource source({}, camera);
  open(source, camera);
  camera.deliver({.flags = V4L2_BUF_FLAG_ERROR, .sequence = 0});
  camera.deliver({.bytes_used = 64 * 48 - 1, .sequence = 1});
  CHECK_FALSE(source.next().has_value());
  camera.deliver({.bytes_used = 0xffff'ffff, .sequence = 2});
  CHECK_FALSE(source.next().has_value());
  CHECK(source.drops().damaged >= 2);
  camera.deliver({.sequence = 3});
  auto lease = wait_for_frame(source);
  REQUIRE(lease.has_value());
  CHECK(lease->frame().number == 3);
  CHECK(source.drops().damaged == 3);
  lease->give_back();
  CHECK(camera.state().queued.size() == 4);
}

TEST_CASE("what was dropped and what was lent add up to the frame's number") {
  FakeCamera camera;
  CameraSource source({}, camera);
  open(source, camera);
  camera.deliver({.sequence = 0});
  camera.deliver({.flags = V4L2_BUF_FLAG_ERROR, .sequence = 1});  // after the newest valid one
  auto lease = wait_for_frame(source);
  REQUIRE(lease.has_value());
  CHECK(lease->frame().number == 0);
  CHECK(source.dropped() == 0);
  lease->give_back();
  camera.deliver({.sequence = 2});
  lease = std::nullopt;
  const auto second = wait_for_frame(source);
  REQUIRE(second.has_value());
  CHECK(second->frame().number == 2);
  CHECK(source.dropped() == 1);
}

TEST_CASE("a buffer that is not the driver's breaks the stream, not the program") {
  for (const std::uint32_t index : {4U, 77U, 0xffff'ffffU}) {
    FakeCamera camera;
    CameraSource source({}, camera);
    stream(source, camera);
    camera.deliver({.index = index});
    CHECK(reaches(source, CameraState::kLost));
    open(source, camera);
    camera.deliver({.sequence = 0});
    const auto lease = wait_for_frame(source);
    REQUIRE(lease.has_value());
    CHECK(source.state() == CameraState::kStreaming);
  }
}

TEST_CASE("a buffer that the driver refuses is offered again") {
  FakeCamera camera;
  CameraSource source({}, camera);
  open(source, camera);
  camera.deliver({.sequence = 0});
  auto lease = wait_for_frame(source);
  REQUIRE(lease.has_value());
  camera.state().refuse_queue = true;
  lease->give_back();
  CHECK(camera.state().queued.size() == 3);
  camera.state().refuse_queue = false;
  camera.deliver({.sequence = 1});
  lease = std::nullopt;
  REQUIRE(wait_for_frame(source).has_value());
  CHECK(camera.state().queued.size() == 4);
}

TEST_CASE("an unplugged camera is lost, closed, and taken back as it was set") {
  FakeCamera camera;
  camera.state().controls = {
      {V4L2_CID_BRIGHTNESS, "Brightness", V4L2_CTRL_TYPE_INTEGER, 0, 9, 1, 0, {}}};
  CameraParameters parameters;
  parameters.controls = {{"brightness", "5"}};
  CameraSource source(parameters, camera);
  stream(source, camera);

  camera.unplug();
  CHECK(reaches(source, CameraState::kLost));
  CHECK(source.identity() == "Fake, serial A");
  CHECK(camera.state().open_now == 0);
  CHECK(camera.state().mapped_now == 0);
  CHECK_THROWS_AS(source.controls()->list(), CameraError);

  camera.plug();
  camera.state().controls[0].value = 1;  // it forgot
  open(source, camera);
  CHECK(source.state() == CameraState::kLost);  // no frame yet
  camera.deliver({.sequence = 0});
  const auto lease = wait_for_frame(source);
  REQUIRE(lease.has_value());
  CHECK(lease->frame().number == 1);  // numbers go on
  CHECK(source.dropped() == 0);
  CHECK(camera.state().controls[0].value == 5);
}

TEST_CASE(
    "whoever asks is told what the camera is waited for, and by when it comes or is tried again") {
  FakeCamera camera;
  camera.state().plugged = false;
  CameraSource source({}, camera);
  CHECK(source.waits_because().empty());  // it has not been looked for
  CHECK(source.due_ns() <= monotonic_ns());
  REQUIRE(wait_for_descriptor(source.descriptor(), kTimeoutMs));
  CHECK_FALSE(source.next().has_value());
  CHECK(source.waits_because() == "there is no camera that can capture");
  const std::int64_t before_ns = source.due_ns();
  REQUIRE(wait_for_descriptor(source.descriptor(), kTimeoutMs));
  CHECK(monotonic_ns() >= before_ns);
  source.next();
  CHECK(source.due_ns() > before_ns);

  camera.state().plugged = true;
  open(source, camera);
  camera.deliver({.sequence = 0});
  const std::int64_t delivered_ns = monotonic_ns();
  REQUIRE(wait_for_frame(source).has_value());
  CHECK(source.waits_because().empty());
  // Four frames' time at 30 frames/s is less than the time-out.
  CHECK(source.due_ns() >= delivered_ns + 400'000'000);
  CHECK(source.due_ns() <= monotonic_ns() + 400'000'000);

  camera.break_off(ENODEV);
  CHECK(reaches(source, CameraState::kLost));
  CHECK(source.waits_because().find("/dev/video0") != std::string_view::npos);
}

TEST_CASE("another camera is not taken in place of the lost one") {
  FakeCamera camera;
  CameraSource source({}, camera);
  stream(source, camera);
  camera.state().others = {{"/dev/video2", {}, "Fake", "usb-2", "B", "fake", false, ""}};
  camera.unplug();
  CHECK(reaches(source, CameraState::kLost));
  const int opens = camera.state().opens;
  for (int i = 0; i < 5; ++i) {
    REQUIRE(wait_for_descriptor(source.descriptor(), kTimeoutMs));
    source.next();
  }
  CHECK(camera.state().opens == opens);
}

TEST_CASE(
    "a source made anew by a reload waits for the same camera, with the controls set meanwhile") {
  FakeCamera camera;
  camera.state().controls = {
      {V4L2_CID_BRIGHTNESS, "Brightness", V4L2_CTRL_TYPE_INTEGER, 0, 9, 1, 0, {}, 0}};
  CameraSource before({}, camera);
  stream(before, camera);
  before.controls()->set("brightness", "7");
  camera.state().others = {{"/dev/video2", {}, "Fake", "usb-2", "B", "fake", false, ""}};
  camera.unplug();
  CHECK(reaches(before, CameraState::kLost));

  CameraParameters parameters;
  parameters.buffers = 3;
  CameraSource source(parameters, camera);
  source.follow(before);
  CHECK(source.identity() == "Fake, serial A");
  const int opens = camera.state().opens;
  for (int i = 0; i < 3; ++i) {
    REQUIRE(wait_for_descriptor(source.descriptor(), kTimeoutMs));
    source.next();
  }
  CHECK(camera.state().opens == opens);
  camera.plug();
  camera.state().controls[0].value = 1;
  open(source, camera);
  CHECK(camera.state().controls[0].value == 7);

  parameters.choice.card = "Fake";
  parameters.controls = {{"brightness", "3"}};
  CameraSource other(parameters, camera);
  other.follow(before);
  CHECK(other.identity().empty());
  CHECK(other.controls()->wanted().at("brightness") == "3");
}

TEST_CASE("a camera that went before its first frame may be replaced by another") {
  FakeCamera camera;
  CameraSource source({}, camera);
  open(source, camera);
  camera.unplug();
  REQUIRE(wait_for_descriptor(source.descriptor(), kTimeoutMs));
  CHECK_FALSE(source.next().has_value());
  CHECK(source.identity().empty());
  camera.state().others = {{"/dev/video2", {}, "Fake", "usb-2", "B", "fake", false, ""}};
  camera.state().listed = false;
  camera.plug();  // the fake opens its one device for all nodes
  open(source, camera);
  camera.deliver({.sequence = 0});
  CHECK(wait_for_frame(source).has_value());
}

TEST_CASE("every way to fail at the start is waited out") {
  FakeCamera camera;
  SUBCASE("busy") {
    camera.state().busy_starts = 3;
  }
  SUBCASE("silent in between") {
    camera.state().error = EIO;
  }
  CameraSource source({}, camera);
  for (int i = 0; i < 4; ++i) {
    REQUIRE(wait_for_descriptor(source.descriptor(), kTimeoutMs));
    source.next();
    if (camera.state().starts > 0 && camera.state().error != 0) camera.break_off(EIO);
  }
  camera.state().error = 0;
  while (!camera.state().streaming) {
    REQUIRE(wait_for_descriptor(source.descriptor(), kTimeoutMs));
    source.next();
  }
  camera.deliver({.sequence = 0});
  CHECK(wait_for_frame(source).has_value());
}

TEST_CASE("a driver that lies about its frames or buffers is refused") {
  FakeCamera camera;
  SUBCASE("rows shorter than their pixels") {
    camera.state().row_stride = 63;
  }
  SUBCASE("frames without pixels") {
    camera.state().width = 0;
  }
  SUBCASE("one buffer") {
    camera.state().buffer_count = 1;
  }
  SUBCASE("very many buffers") {
    camera.state().buffer_count = 1'000'000;
  }
  CameraSource source({}, camera);
  for (int i = 0; i < 3; ++i) {
    REQUIRE(wait_for_descriptor(source.descriptor(), kTimeoutMs));
    CHECK_FALSE(source.next().has_value());
  }
  CHECK(source.state() == CameraState::kStarting);
  CHECK(camera.state().open_now == 0);
  CHECK(camera.state().mapped_now == 0);
}

TEST_CASE("frames whose buffers are smaller than their luma are damaged") {
  FakeCamera camera;
  camera.state().buffer_bytes = 64 * 47;
  CameraSource source({}, camera);
  open(source, camera);
  camera.deliver({.sequence = 0});
  REQUIRE(wait_for_descriptor(source.descriptor(), kTimeoutMs));
  CHECK_FALSE(source.next().has_value());
  CHECK(source.drops().damaged == 1);
}

TEST_CASE("a silent camera is lost when its time is over") {
  FakeCamera camera;
  camera.state().interval = {1, 1000};
  CameraParameters parameters;
  parameters.timeout_s = 0.05;
  CameraSource source(parameters, camera);
  stream(source, camera);
  CHECK(reaches(source, CameraState::kLost));
  CHECK(camera.state().starts == 1);
  open(source, camera);  // and started again
}

TEST_CASE("where all buffers are full and stamps can't be trusted, none is passed off as new") {
  FakeCamera camera;
  CameraSource source({}, camera);
  open(source, camera);
  for (std::uint32_t i = 0; i < 4; ++i) camera.deliver({.sequence = i, .no_clock = true});
  REQUIRE(wait_for_descriptor(source.descriptor(), kTimeoutMs));
  CHECK_FALSE(source.next().has_value());
  CHECK(source.drops().stale == 1);
  camera.deliver({.sequence = 4, .no_clock = true});
  const auto lease = wait_for_frame(source);
  REQUIRE(lease.has_value());
  CHECK(lease->frame().stamp_source == StampSource::kArrival);
  CHECK(lease->frame().number == 4);
  CHECK(source.dropped() == 4);
}

TEST_CASE("several planes: the first one is read") {
  FakeCamera camera;
  camera.state().multiplanar = true;
  camera.state().formats = {V4L2_PIX_FMT_NV12M};
  CameraSource source({}, camera);
  open(source, camera);
  camera.deliver({.sequence = 0, .fill = 9});
  const auto lease = wait_for_frame(source);
  REQUIRE(lease.has_value());
  CHECK(lease->frame().luma.data == camera.state().memory[0].data());
}

TEST_CASE("cached buffers are asked for where the driver has them") {
  FakeCamera camera;
  for (const bool offered : {false, true}) {
    camera.state().capabilities = offered ? V4L2_BUF_CAP_SUPPORTS_MMAP_CACHE_HINTS : 0U;
    const std::unique_ptr<VideoDevice> device = camera.open("");
    const CaptureStream stream(*device, false, 4);
    CHECK(stream.cached() == offered);
  }
}

TEST_CASE("libv4l2 is taken only where no format can be read as it is") {
  FakeCamera camera;
  camera.state().emulated = {V4L2_PIX_FMT_YUV420};
  camera.state().formats = {V4L2_PIX_FMT_BGR24, V4L2_PIX_FMT_YUYV};
  camera.state().row_stride = 128;
  {
    CameraSource source({}, camera);
    open(source, camera);
    CHECK(camera.state().set_fourcc == V4L2_PIX_FMT_YUYV);
  }
  camera.state().formats = {V4L2_PIX_FMT_BGR24};
  CameraSource source({}, camera);
  open(source, camera);
  CHECK(camera.state().set_fourcc == V4L2_PIX_FMT_YUV420);
  CHECK(source.description().find("libv4l2") != std::string::npos);
}

TEST_CASE("a part of the picture is read in place") {
  FakeCamera camera;
  CameraParameters parameters;
  parameters.mode.crop = {10, 20, 30, 16};
  CameraSource source(parameters, camera);
  open(source, camera);
  camera.deliver({.sequence = 0});
  const auto lease = wait_for_frame(source);
  REQUIRE(lease.has_value());
  CHECK(lease->frame().luma.data == camera.state().memory[0].data() + 20 * 64 + 10);
  CHECK(source.width() == 30);
  CHECK(source.height() == 16);
  CHECK(source.crop() == "30x16 from (10, 20)");
}

TEST_CASE("taking frames allocates nothing") {
  FakeCamera camera;
  CameraSource source({}, camera);
  open(source, camera);
  for (std::uint32_t i = 0; i < 20; ++i) {
    camera.deliver({.sequence = i});
    REQUIRE(wait_for_descriptor(source.descriptor(), kTimeoutMs));
    const AllocationCounter counter;
    auto lease = source.next();
    if (lease) lease->give_back();
    if (i > 2) CHECK(counter.count() == 0);
  }
}
