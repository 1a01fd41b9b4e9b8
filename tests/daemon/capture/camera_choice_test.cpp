#include <doctest/doctest.h>
#include <sys/stat.h>

#include <filesystem>

#include "daemon/capture/camera_information.hpp"
#include "daemon/capture/video_device.hpp"
#include "tests/error_of.hpp"
#include "tests/temporary_directory.hpp"

using namespace roundel;

namespace {

const CameraInformation kFirst = {"/dev/video0", {"/dev/v4l/by-id/usb-A", "/dev/v4l/by-path/1"},
                                  "HD Webcam",   "usb-1",
                                  "A1",          "uvcvideo",
                                  false,         ""};
const CameraInformation kTwin = {
    "/dev/video2", {"/dev/v4l/by-path/2"}, "HD Webcam", "usb-2", "A2", "uvcvideo", false, ""};
const CameraInformation kNameless = {"/dev/video4", {},   "Sensor", "platform:csi", "",
                                     "csi",         true, ""};
const std::vector<CameraInformation> kAll = {kFirst, kTwin, kNameless};

std::string chosen(const CameraChoice& choice) {
  return choose_camera(kAll, choice).node;
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("without any rule the first camera is taken") {
  CHECK(chosen({}) == "/dev/video0");
  CHECK(contains(error_of([] { choose_camera({}, {}); }), "no camera that can capture"));
}

TEST_CASE("a camera is found by its node or any of its links") {
  CHECK(chosen({.device = "/dev/video2"}) == "/dev/video2");
  CHECK(chosen({.device = "/dev/v4l/by-path/1"}) == "/dev/video0");
  const std::string error = error_of([] { chosen({.device = "/dev/video9"}); });
  CHECK(contains(error, "no camera is at /dev/video9"));
  CHECK(contains(error, "HD Webcam (/dev/video0, usb-1, serial A1)"));
  const TemporaryDirectory folder;
  std::filesystem::create_symlink("/dev/null", folder.file("arena"));
  CameraInformation other = kTwin;
  other.node = "/dev/null";
  CHECK(choose_camera({kFirst, other}, {.device = folder.file("arena")}).node == "/dev/null");
}

TEST_CASE("rules that leave one camera decide, rules that leave two say so with both") {
  CHECK(chosen({.card = "Sensor"}) == "/dev/video4");
  CHECK(chosen({.card = "Webcam", .serial = "A2"}) == "/dev/video2");
  CHECK(chosen({.bus = "usb-2"}) == "/dev/video2");
  const std::string error = error_of([] { chosen({.card = "Webcam"}); });
  CHECK(contains(error, "match_card \"Webcam\" fits 2 cameras"));
  CHECK(contains(error, "/dev/video0"));
  CHECK(contains(error, "/dev/video2"));
  CHECK(contains(error, "camera.device"));
  CHECK_THROWS_AS(chosen({.serial = "B"}), CameraAbsent);
}

TEST_CASE("a camera is found again wherever it is, by its serial number") {
  CameraInformation moved = kFirst;
  moved.node = "/dev/video6";
  moved.bus = "usb-7";
  CHECK(find_again({kTwin, moved}, kFirst).node == "/dev/video6");
  CHECK_THROWS_AS(find_again({kTwin, kNameless}, kFirst), CameraError);
  CHECK_THROWS_AS(find_again({}, kFirst), CameraAbsent);
}

TEST_CASE("without a serial number, or with one that twins share, the place decides") {
  CameraInformation moved = kNameless;
  moved.bus = "platform:other";
  CHECK_THROWS_AS(find_again({moved}, kNameless), CameraError);
  CHECK(find_again({moved, kNameless}, kNameless).bus == "platform:csi");
  CameraInformation same_serial = kTwin;
  same_serial.serial = "A1";
  CHECK(find_again({same_serial, kFirst}, kFirst).node == "/dev/video0");
  CameraInformation third = same_serial;
  third.bus = "usb-3";
  CHECK_THROWS_AS(find_again({same_serial, third}, kFirst), CameraError);
}

TEST_CASE("of a camera that can't be opened it is told why, whoever asks for it") {
  CameraInformation locked;
  locked.node = "/dev/video6";
  locked.card = "Locked";
  locked.serial = "L1";
  locked.problem = "/dev/video6: permission denied";
  const std::string by_node = error_of([&] {
    choose_camera({kFirst, locked}, {.device = "/dev/video6"});
  });
  CHECK(by_node == "/dev/video6: permission denied");
  CHECK(choose_camera({locked, kFirst}, {}).node == "/dev/video0");
  CHECK(contains(error_of([&] { choose_camera({locked}, {}); }), "permission denied"));
  CHECK(contains(error_of([&] {
                   choose_camera({kFirst, locked}, {.card = "Locked"});
                 }),
                 "permission denied"));
  CameraInformation before = locked;
  before.problem.clear();
  CHECK(error_of([&] {
          find_again({kFirst, locked}, before);
        }) == "/dev/video6: permission denied");
}

TEST_CASE("what is no camera is not opened, but named") {
  const TemporaryDirectory folder;
  const std::string pipe = folder.file("pipe");
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  for (const std::string& path : {pipe, folder.write("file", "text"), folder.file(""),
                                  std::string("/dev/null"), std::string("relative")}) {
    CHECK(contains(error_of([&] { chosen({.device = path}); }), "no camera is at " + path));
  }
}
