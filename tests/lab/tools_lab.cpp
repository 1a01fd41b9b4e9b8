// What a user sees of a camera: roundel cameras, status and controls.
#include <doctest/doctest.h>
#include <unistd.h>

#include <csignal>
#include <nlohmann/json.hpp>

#include "daemon/capture/video_device.hpp"
#include "tests/child_process.hpp"
#include "tests/lab/daemon_under_test.hpp"
#include "tests/lab/report.hpp"
#include "tests/lab/usb_camera.hpp"

using namespace roundel;

namespace {

constexpr int kPatienceMs = 20'000;

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

Finished roundel_says(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), ROUNDEL_BINARY);
  return run_program(arguments);
}

}  // namespace

TEST_CASE("roundel lists cameras with their formats, sizes, rates and controls") {
  CHECK(roundel_says({"cameras"}).status == 1);
  const Film& film = Film::shared();
  UsbCameraDescription description;
  description.formats = {UsbFormat::kYuyv, UsbFormat::kJpeg};
  const UsbCamera camera(film, description);
  const auto links_are_there = [] {
    const std::vector<CameraInformation> cameras = kernel_cameras().cameras();
    return cameras.size() == 1 && cameras[0].links.size() >= 2;
  };
  for (int i = 0; i < 1000 && !links_are_there(); ++i) ::usleep(10'000);

  const Finished text = roundel_says({"cameras"});
  CHECK(text.status == 0);
  CAPTURE(text.output);
  CHECK(has(text.output, "Roundel lab (/dev/video0, usb-vhci_hcd.0-1, serial LAB0001)"));
  CHECK(has(text.output, "/dev/v4l/by-id/usb-Roundel"));
  CHECK(has(text.output, "(read in place)"));
  CHECK(has(text.output, "(decoded, luma alone)"));
  CHECK(has(text.output, "640x480 at 30, 15/s"));
  CHECK(has(text.output, "auto_exposure"));
  CHECK(has(text.output, "1 to 5000"));

  const Finished lines = roundel_says({"cameras", "--json"});
  const nlohmann::json json = nlohmann::json::parse(lines.output);
  CHECK(json.at("device") == "/dev/video0");
  CHECK(json.at("formats").at(0).at("format") == "YUYV");
  CHECK(json.at("formats").at(1).at("sizes").at(0).at("frame_rates").at(1) == 15);
  CHECK(json.at("controls").size() >= 3);
}

TEST_CASE("status and controls of a running roundeld, also while its camera is away") {
  const Film& film = Film::shared();
  UsbCameraDescription description;
  description.formats = {UsbFormat::kGrey};
  UsbCamera camera(film, description);
  DaemonUnderTest daemon(film, {});
  REQUIRE(daemon.poses_arrive(kPatienceMs));
  daemon.receive(2000);
  const auto ask = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"--socket", daemon.socket()});
    return roundel_says(arguments);
  };

  const Finished text = ask({"status"});
  CAPTURE(text.output);
  CHECK(has(text.output, "GREY 640x480 at 30 frames/s, read in place"));
  CHECK(has(text.output, "handling"));
  const nlohmann::json status = nlohmann::json::parse(ask({"status", "--json"}).output);
  CHECK(status.at("camera").at("state") == "streaming");
  CHECK(status.at("latency_us").at("handling").at("p99") > 0);
  CHECK(status.at("latency_us").at("following").at("p50") > 0);
  CHECK(status.at("drops").at("damaged") == 0);
  CHECK(status.at("stamp_source") == "start_of_frame");

  CHECK(has(ask({"controls"}).output, "exposure_time_absolute"));
  CHECK(ask({"controls", "auto_exposure=Manual Mode"}).status == 0);
  CHECK(ask({"controls", "exposure_time_absolute=77"}).status == 0);
  CHECK(camera.exposure_time() == 77);
  CHECK(has(ask({"controls", "exposure_time_absolute=0"}).errors, "from 1 to 5000"));
  CHECK(has(ask({"controls", "shutter=1"}).errors, "no such control"));

  camera.unplug();
  daemon.receive(1500);
  CHECK(has(ask({"status"}).output, "lost"));
  CHECK(has(ask({"controls"}).errors, "not there"));
  daemon.process().signal(SIGHUP);
  CHECK(daemon.process().wait_for("nothing has changed", std::chrono::milliseconds(kPatienceMs)));
  camera.plug();
  REQUIRE(daemon.poses_arrive(kPatienceMs));
  CHECK(camera.exposure_time() == 77);
}
