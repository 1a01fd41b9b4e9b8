#include <doctest/doctest.h>
#include <linux/videodev2.h>

#include "daemon/capture/camera_mode.hpp"
#include "tests/error_of.hpp"

using namespace roundel;

namespace {

OfferedFormat offer(std::uint32_t fourcc, std::vector<OfferedSize> sizes, bool emulated = false) {
  return {fourcc, "", emulated, std::move(sizes)};
}

// An ordinary webcam: uncompressed is slow when large.
const std::vector<OfferedFormat> kWebcam = {
    offer(V4L2_PIX_FMT_MJPEG,
          {{640, 480, {30}}, {1280, 720, {30}}, {1920, 1080, {30}}, {3840, 2160, {30}}}),
    offer(V4L2_PIX_FMT_YUYV, {{640, 480, {60, 30}}, {1280, 720, {10}}, {1920, 1080, {5}}})};

}  // namespace

TEST_CASE("the largest size up to Full HD that reaches the rate, in the format that costs least") {
  const ModeChoice choice = choose_mode(kWebcam, {});
  CHECK(choice.format->fourcc == V4L2_PIX_FMT_MJPEG);
  CHECK(choice.width == 1920);
  CHECK(choice.height == 1080);
  ModeRequest slow;
  slow.frame_rate = 5;
  CHECK(choose_mode(kWebcam, slow).format->fourcc == V4L2_PIX_FMT_YUYV);
}

TEST_CASE("in a wanted size the cheapest format that reaches the rate is taken") {
  ModeRequest request;
  request.width = 640;
  request.height = 480;
  CHECK(choose_mode(kWebcam, request).format->fourcc == V4L2_PIX_FMT_YUYV);
  request.width = 1280;
  request.height = 720;
  CHECK(choose_mode(kWebcam, request).format->fourcc == V4L2_PIX_FMT_MJPEG);
  request.fourcc = V4L2_PIX_FMT_YUYV;
  CHECK(choose_mode(kWebcam, request).format->fourcc == V4L2_PIX_FMT_YUYV);
  request = {};
  request.width = 3840;
  CHECK(choose_mode(kWebcam, request).height == 2160);
}

TEST_CASE("if no format reaches the rate, the fastest is taken") {
  ModeRequest request;
  request.frame_rate = 120;
  const ModeChoice choice = choose_mode(kWebcam, request);
  CHECK(choice.width == 640);
  CHECK(choice.format->fourcc == V4L2_PIX_FMT_YUYV);
}

TEST_CASE("grey before luma planes before packed before reduced before Bayer before JPEG") {
  const std::vector<std::uint32_t> order = {V4L2_PIX_FMT_GREY,   V4L2_PIX_FMT_NV12,
                                            V4L2_PIX_FMT_YUYV,   V4L2_PIX_FMT_Y10,
                                            V4L2_PIX_FMT_SRGGB8, V4L2_PIX_FMT_MJPEG};
  for (std::size_t first = 0; first < order.size(); ++first) {
    std::vector<OfferedFormat> offered;
    for (std::size_t i = order.size(); i > first; --i) {
      offered.push_back(offer(order[i - 1], {{640, 480, {30}}}));
    }
    CHECK(choose_mode(offered, {}).format->fourcc == order[first]);
  }
}

TEST_CASE("a native format is taken before any that libv4l2 emulates") {
  const std::vector<OfferedFormat> offered = {offer(V4L2_PIX_FMT_YUV420, {{640, 480, {30}}}, true),
                                              offer(V4L2_PIX_FMT_MJPEG, {{640, 480, {30}}})};
  CHECK(choose_mode(offered, {}).format->fourcc == V4L2_PIX_FMT_MJPEG);
}

TEST_CASE("where the driver tells no sizes, the one that is set stays") {
  const ModeChoice choice = choose_mode({offer(V4L2_PIX_FMT_GREY, {})}, {});
  CHECK(choice.width == 0);
  ModeRequest request;
  request.width = 800;
  CHECK(choose_mode({offer(V4L2_PIX_FMT_GREY, {})}, request).width == 800);
}

TEST_CASE("what a camera does not have is told with what it has") {
  ModeRequest request;
  request.width = 800;
  request.height = 600;
  CHECK(error_of([&] {
          choose_mode(kWebcam, request);
        }).find("no frames of 800x600; it has 640x480, 1280x720") != std::string::npos);
  request = {};
  request.fourcc = V4L2_PIX_FMT_GREY;
  CHECK(error_of([&] { choose_mode(kWebcam, request); }) ==
        "it has no format GREY; it has MJPG, YUYV");
  CHECK_THROWS_AS(choose_mode({offer(V4L2_PIX_FMT_RGB24, {})}, {}), CameraError);
  CHECK_THROWS_AS(choose_mode({}, {}), CameraError);
}
