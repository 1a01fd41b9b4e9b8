// Drivers that say what can't be. None may bring roundeld down, hold it up, or have it read memory
// that is not a frame's.
#include <doctest/doctest.h>
#include <fcntl.h>

#include <cerrno>
#include <limits>

#include "daemon/capture/device_controls.hpp"
#include "tests/daemon/capture/camera_rig.hpp"

using namespace roundel;

namespace {

// Looks after a source whose camera can't be used, through three tries.
void expect_no_camera(const FakeCamera& camera) {
  CameraSource source({}, camera);
  for (int i = 0; i < 3; ++i) {
    REQUIRE(wait_for_descriptor(source.descriptor(), kTimeoutMs));
    CHECK_FALSE(source.next().has_value());
  }
  CHECK(source.state() == CameraState::kStarting);
  CHECK(camera.state().open_now == 0);
  CHECK(camera.state().mapped_now == 0);
}

}  // namespace

TEST_CASE("a frame of no bytes is damaged") {
  FakeCamera camera;
  CameraSource source({}, camera);
  open(source, camera);
  camera.deliver({.bytes_used = 0});
  REQUIRE(wait_for_descriptor(source.descriptor(), kTimeoutMs));
  CHECK_FALSE(source.next().has_value());
  camera.deliver({.sequence = 1});
  REQUIRE(wait_for_frame(source).has_value());
  CHECK(source.drops().damaged == 1);
}

TEST_CASE("of several planes, data that begins behind its end is damaged") {
  FakeCamera camera;
  camera.state().multiplanar = true;
  camera.state().formats = {V4L2_PIX_FMT_NV12M};
  CameraSource source({}, camera);
  open(source, camera);
  camera.deliver({.data_offset = 64 * 48 + 1, .sequence = 0});
  camera.deliver({.bytes_used = 0xffff'ffff, .data_offset = 16, .sequence = 1});
  camera.deliver({.data_offset = 16, .sequence = 2});  // too short for its luma
  camera.deliver({.sequence = 3});
  const auto lease = wait_for_frame(source);
  REQUIRE(lease.has_value());
  CHECK(lease->frame().number == 3);
  CHECK(source.drops().damaged >= 2);
  CHECK(source.drops().total() == 3);
}

TEST_CASE("a buffer that is returned twice breaks the stream") {
  FakeCamera camera;
  CameraSource source({}, camera);
  stream(source, camera);
  camera.deliver({.index = 1, .sequence = 1});
  camera.deliver({.index = 1, .sequence = 2});
  CHECK(reaches(source, CameraState::kLost));
  CHECK(camera.state().mapped_now == 0);
}

TEST_CASE("time stamps that are no times are refused") {
  constexpr auto kMost = std::numeric_limits<std::int64_t>::max();
  constexpr auto kLeast = std::numeric_limits<std::int64_t>::min();
  for (const timeval& stamp :
       {timeval{kMost, 0}, timeval{kLeast, 0}, timeval{1, kMost}, timeval{1, kLeast},
        timeval{kMost / 1'000'000, 999'999}, timeval{0, 0}, timeval{-1, -1}}) {
    FakeCamera camera;
    CameraSource source({}, camera);
    open(source, camera);
    camera.deliver({.stamp = stamp});
    const auto lease = wait_for_frame(source);
    REQUIRE(lease.has_value());
    CHECK(lease->frame().stamp_source == StampSource::kArrival);
    CHECK(std::abs(lease->frame().captured.mono_us - now().mono_us) < 60'000'000);
  }
}

TEST_CASE("frame rates that can't be are as good as none") {
  for (const v4l2_fract& interval : {v4l2_fract{0, 0}, v4l2_fract{1, 0}, v4l2_fract{0, 1},
                                     v4l2_fract{0xffff'ffff, 1}, v4l2_fract{1, 0xffff'ffff}}) {
    FakeCamera camera;
    camera.state().interval = interval;
    CameraSource source({}, camera);
    open(source, camera);
    camera.deliver({.sequence = 0});
    CHECK(wait_for_frame(source).has_value());
    CHECK_FALSE(source.next().has_value());
    CHECK(source.state() == CameraState::kStreaming);
  }
}

TEST_CASE("a camera that only gives damaged frames is lost") {
  FakeCamera camera;
  camera.state().interval = {1, 1000};
  CameraParameters parameters;
  parameters.timeout_s = 0.05;
  CameraSource source(parameters, camera);
  stream(source, camera);
  camera.deliver({.flags = V4L2_BUF_FLAG_ERROR, .sequence = 1});
  camera.deliver({.bytes_used = 1, .sequence = 2});
  CHECK(reaches(source, CameraState::kLost));
  CHECK(source.drops().damaged == 2);
}

TEST_CASE("whatever error a driver has for its frames, it is lost and tried again") {
  for (const int error : {EINVAL, EPIPE, ENOMEM, EIO, ENODEV, EFAULT, ENOTTY, 1000}) {
    CAPTURE(error);
    FakeCamera camera;
    CameraSource source({}, camera);
    stream(source, camera);
    camera.break_off(error);
    CHECK(reaches(source, CameraState::kLost));
    camera.state().error = 0;
    open(source, camera);
    camera.deliver({.sequence = 0});
    CHECK(wait_for_frame(source).has_value());
  }
}

TEST_CASE("a driver that sets something else than it was asked for is refused") {
  FakeCamera camera;
  SUBCASE("another format") {
    camera.state().forced_fourcc = V4L2_PIX_FMT_YUYV;
  }
  SUBCASE("another size") {
    camera.state().forced_width = 32;
  }
  SUBCASE("no buffers") {
    camera.state().errors[VIDIOC_REQBUFS] = ENOMEM;
  }
  SUBCASE("buffers that can't be looked at") {
    camera.state().errors[VIDIOC_QUERYBUF] = EINVAL;
  }
  SUBCASE("buffers without memory") {
    camera.state().buffer_bytes = 0;
  }
  SUBCASE("memory that can't be mapped") {
    camera.state().refuse_maps = true;
  }
  SUBCASE("new buffers that it does not take") {
    camera.state().refuse_queue = true;
  }
  SUBCASE("a stream that does not start") {
    camera.state().errors[VIDIOC_STREAMON] = EPIPE;
  }
  SUBCASE("no formats") {
    camera.state().errors[VIDIOC_ENUM_FMT] = EINVAL;
  }
  SUBCASE("frames that can't be waited for") {
    // The kernel refuses to poll ordinary files.
    camera.state().ready = UniqueFd(::open("/proc/self/exe", O_RDONLY | O_CLOEXEC));
  }
  expect_no_camera(camera);
}

TEST_CASE("a camera that comes back with other frames is read as it is now") {
  FakeCamera camera;
  CameraSource source({}, camera);
  stream(source, camera);
  camera.unplug();
  CHECK(reaches(source, CameraState::kLost));

  FakeCamera::State& state = camera.state();
  camera.plug();
  state.formats = {V4L2_PIX_FMT_YUYV};
  state.width = 32;
  state.height = 24;
  state.row_stride = 64;
  state.buffer_bytes = 64 * 24;
  open(source, camera);
  camera.deliver({.sequence = 0, .fill = 5});
  const auto lease = wait_for_frame(source);
  REQUIRE(lease.has_value());
  CHECK(lease->frame().luma.width == 32);
  CHECK(lease->frame().luma.height == 24);
  CHECK(lease->frame().luma.pixel_stride == 2);
}

TEST_CASE("lists that never end are not followed for ever") {
  FakeCamera camera;
  camera.state().endless = true;
  camera.state().controls = {
      {V4L2_CID_BRIGHTNESS, "Brightness", V4L2_CTRL_TYPE_INTEGER, 0, 9, 1, 0, {}, 0}};
  CameraParameters parameters;
  parameters.controls = {{"brightness", "5"}};
  CameraSource source(parameters, camera);
  open(source, camera);
  camera.deliver({.sequence = 0});
  CHECK(wait_for_frame(source).has_value());
  CHECK(list_controls(*camera.open("")).size() == 1000);
}

TEST_CASE("controls of absurd ranges are listed without harm, arrays have no value to set") {
  constexpr auto kMost = std::numeric_limits<std::int64_t>::max();
  constexpr auto kLeast = std::numeric_limits<std::int64_t>::min();
  FakeCamera camera;
  camera.state().controls = {
      {1, "Whole\x1b[31m Range", V4L2_CTRL_TYPE_MENU, kLeast, kMost, 0, 0, {"a", "b"}, 0},
      {2, "Far", V4L2_CTRL_TYPE_MENU, kMost - 3, kMost, 0, 0, {}, 0},
      {3, "Backward", V4L2_CTRL_TYPE_INTEGER, 9, -9, 0, 0, {}, 0},
      {4, "Table", V4L2_CTRL_TYPE_INTEGER, 0, 9, 0, 0, {}, V4L2_CTRL_FLAG_HAS_PAYLOAD}};
  const std::vector<Control> controls = list_controls(*camera.open(""));
  REQUIRE(controls.size() == 4);
  CHECK(controls[0].label == "Whole [31m Range");
  CHECK(controls[0].menu.size() == 2);
  CHECK(controls[1].menu.empty());
  CHECK_THROWS_AS(parse_control_value(controls[2], "0"), std::invalid_argument);
  CHECK(controls[3].type == Control::Type::kOther);
  CHECK_THROWS_AS(parse_control_value(controls[3], "1"), std::invalid_argument);
}
