// What `roundel doctor` says about cameras, by one that is no kernel's.
#include <doctest/doctest.h>
#include <linux/videodev2.h>

#include <filesystem>
#include <fstream>

#include "tests/daemon/capture/fake_camera.hpp"
#include "tests/temporary_directory.hpp"
#include "tools/doctor/camera_checks.hpp"

using namespace roundel;

namespace {

LoadedConfiguration configuration(std::vector<std::string> overrides = {}) {
  overrides.emplace_back("source=camera");
  return default_configuration(overrides);
}

FakeCamera webcam() {
  FakeCamera camera;
  FakeCamera::State& state = camera.state();
  state.formats = {V4L2_PIX_FMT_YUYV};
  state.width = 1280;
  state.height = 720;
  state.controls = {{V4L2_CID_EXPOSURE_AUTO,
                     "Auto Exposure",
                     V4L2_CTRL_TYPE_MENU,
                     0,
                     3,
                     3,
                     0,
                     {"", "Manual Mode", "", "Aperture Priority Mode"}}};
  return camera;
}

// A machine whose camera hangs on a USB bus of that speed.
class UsbMachine {
 public:
  explicit UsbMachine(const std::string& node, const std::string& speed) {
    namespace fs = std::filesystem;
    const fs::path device = folder_.file("sys/devices/usb1/1-1");
    fs::create_directories(device / "1-1:1.0");
    std::ofstream(device / "speed") << speed << "\n";
    const fs::path video =
        folder_.file("sys/class/video4linux/" + fs::path(node).filename().string());
    fs::create_directories(video);
    fs::create_symlink(device / "1-1:1.0", video / "device");
  }
  MachineRoot root() const { return {folder_.file("")}; }

 private:
  TemporaryDirectory folder_;
};

const Finding& named(const std::vector<Finding>& findings, const std::string& check) {
  for (const Finding& finding : findings) {
    if (finding.check == check) return finding;
  }
  FAIL("no finding " << check);
  return findings.front();
}

}  // namespace

TEST_CASE("doctor: no camera is missed where none is needed") {
  const auto findings = check_camera({}, FakeCamera(), default_configuration());
  REQUIRE(findings.size() == 1);
  CHECK(findings[0].verdict == Verdict::kOk);
}

TEST_CASE("doctor: a camera that is not there, or not the one") {
  FakeCamera camera = webcam();
  const auto other = check_camera({}, camera, configuration({"camera.match_card=Elsewhere"}));
  CHECK(other.at(0).verdict == Verdict::kProblem);
  CHECK(other.at(0).remedy.find("plug it in") == 0);
  camera.state().plugged = false;
  camera.state().listed = false;
  CHECK(check_camera({}, camera, configuration()).at(0).verdict == Verdict::kProblem);
}

TEST_CASE("doctor: mode, bandwidth and automatics of the camera") {
  const FakeCamera camera = webcam();
  const std::string node = camera.cameras().at(0).node;
  const UsbMachine usb2(node, "480"), usb3(node, "5000");
  const auto findings = check_camera(usb3.root(), camera, configuration());
  CHECK(named(findings, "camera").verdict == Verdict::kOk);
  CHECK(named(findings, "camera").text.find("1280x720 YUYV") != std::string::npos);
  CHECK(named(findings, "bandwidth").verdict == Verdict::kOk);
  CHECK(named(findings, "automatics").verdict == Verdict::kWarning);
  CHECK(named(findings, "automatics").remedy.find("auto_exposure: Manual Mode") !=
        std::string::npos);

  // 16 bits x 1280 x 720 x 30.
  const Finding narrow = named(check_camera(usb2.root(), camera, configuration()), "bandwidth");
  CHECK(narrow.verdict == Verdict::kWarning);
  CHECK(narrow.text.find("442 Mbit/s, its USB bus has 480") != std::string::npos);

  const auto manual =
      check_camera(usb3.root(), camera, configuration({"camera.controls={auto_exposure: 1}"}));
  CHECK(named(manual, "automatics").verdict == Verdict::kOk);
  const auto fast = check_camera(usb3.root(), camera, configuration({"camera.frame_rate=90"}));
  CHECK(named(fast, "camera").verdict == Verdict::kWarning);
  CHECK(named(fast, "camera").text.find("at most 30 frames/s of the 90 wanted") !=
        std::string::npos);
}
