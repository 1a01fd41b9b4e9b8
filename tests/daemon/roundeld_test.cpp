// roundeld as a robot and as systemd see it: a process that gets signals and sends LCM multicast.
#include <doctest/doctest.h>
#include <sys/stat.h>

#include <csignal>
#include <cstdlib>

#include "tests/child_process.hpp"
#include "tests/private_network.hpp"
#include "tests/temporary_directory.hpp"
#include "transport/subscriber.hpp"

using namespace roundel;
using namespace std::chrono_literals;

namespace {

constexpr auto kPatience = 60s;  // sanitizers are slow

// A port of its own for every test, so that they may run side by side.
std::string url(int port) {
  return "udpm://239.255.76.69:" + std::to_string(port) + "?ttl=0";
}

std::string small_arena(int port, int robots, const std::string& more = "") {
  return "simulator: {width: 640, height: 480, frame_rate: 20, corner_markers: false, clutter: "
         "false, robots: " +
         std::to_string(robots) + "}\nlcm: {url: \"" + url(port) + "\"}\n" + more;
}

std::vector<std::string> command(const std::string& config) {
  return {ROUNDELD_BINARY, "--config", config};
}

// The next frame that is as wanted; nullptr if none comes.
template <typename Wanted>
const ReceivedFrame* wait_for_frame(Subscriber& subscriber, Wanted&& wanted) {
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  while (std::chrono::steady_clock::now() < deadline) {
    const ReceivedFrame* frame = subscriber.next_frame(1s);
    if (frame != nullptr && wanted(*frame)) return frame;
  }
  return nullptr;
}

}  // namespace

TEST_CASE("roundeld sends the poses of a simulated arena and ends at SIGTERM with 0") {
  if (!multicast_is_private()) return;
  constexpr int kPort = 7701;
  const TemporaryDirectory folder;
  Subscriber subscriber(url(kPort), "ROUNDEL");
  ChildProcess daemon(command(folder.write("roundel.yaml", small_arena(kPort, 3))));

  const ReceivedFrame* frame =
      wait_for_frame(subscriber, [](const ReceivedFrame& f) { return f.markers.size() == 3; });
  REQUIRE(frame != nullptr);
  const header_t& header = frame->header;
  CHECK(frame->camera == "camera");
  CHECK(header.width == 640);
  CHECK(header.height == 480);
  CHECK(header.simulated == 1);
  CHECK(header.camera_state == header_t::CAMERA_STREAMING);
  CHECK(header.calibration_state == header_t::CALIBRATION_VALID);
  CHECK(header.stamp_source == header_t::STAMP_MIDDLE_OF_EXPOSURE);
  CHECK(header.capture_mono < header.publish_mono);
  // Both clocks tell the same duration, as far as one is adjusted meanwhile.
  const std::int64_t wall = header.publish_utime - header.capture_utime;
  CHECK(std::abs(wall - (header.publish_mono - header.capture_mono)) < 1000);
  for (const marker_t& marker : frame->markers) {
    CHECK(marker.has_pose == 1);
    CHECK(marker.position[2] > 2);
    CHECK(marker.position[2] < 4);
  }

  REQUIRE(wait_for_frame(subscriber,
                         [&](const ReceivedFrame&) { return subscriber.status().has_value(); }));
  const status_t& status = *subscriber.status();
  CHECK(status.session == header.session);
  CHECK(status.frames > 0);
  CHECK(status.frame_rate > 0);
  CHECK(status.tracking.p50 > 0);
  CHECK(status.total.max >= status.total.p50);
  CHECK(status.url == url(kPort));
  CHECK_FALSE(status.version.empty());
  CHECK(status.source.starts_with("simulator 640x480"));

  daemon.signal(SIGTERM);
  CHECK(daemon.wait(kPatience) == 0);
  CHECK(daemon.errors().find("poses stay on this machine") != std::string::npos);
}

TEST_CASE("roundeld sends frames also when nothing is seen") {
  if (!multicast_is_private()) return;
  constexpr int kPort = 7702;
  const TemporaryDirectory folder;
  Subscriber subscriber(url(kPort), "ROUNDEL");
  ChildProcess daemon(command(folder.write("roundel.yaml", small_arena(kPort, 0))));
  for (int i = 0; i < 3; ++i) {
    const ReceivedFrame* frame = wait_for_frame(subscriber, [](const auto&) { return true; });
    REQUIRE(frame != nullptr);
    CHECK(frame->markers.empty());
  }
  daemon.signal(SIGINT);
  CHECK(daemon.wait(kPatience) == 0);
}

TEST_CASE("a wrong configuration at SIGHUP changes nothing, a right one takes effect") {
  if (!multicast_is_private()) return;
  constexpr int kPort = 7703;
  const TemporaryDirectory folder;
  Subscriber subscriber(url(kPort), "ROUNDEL");
  const std::string path = folder.write("roundel.yaml", small_arena(kPort, 1));
  ChildProcess daemon(command(path));
  const auto any = [](const ReceivedFrame&) { return true; };
  const ReceivedFrame* frame = wait_for_frame(subscriber, any);
  REQUIRE(frame != nullptr);
  const std::int64_t session = frame->header.session;

  // Wrong in the syntax of the file, in the network, in the arena, in a file that it names.
  for (const std::string& wrong :
       {std::string("simulator:\n  robots: many\n"), std::string("lcm: {url: \"tcp://x\"}\n"),
        std::string("simulator: {robots: 450}\n"),
        std::string("camera: {calibration: /nonexistent.yaml}\n")}) {
    folder.write("roundel.yaml", wrong);
    daemon.signal(SIGHUP);
    REQUIRE(daemon.wait_for("the configuration in use stays", kPatience));
    frame = wait_for_frame(subscriber, any);
    REQUIRE(frame != nullptr);
    CHECK(frame->header.session == session);
  }
  CHECK(daemon.errors().find(path + ":2:11: simulator.robots: \"many\"") != std::string::npos);

  // Another marker setting: new tracker and arena, so a new session on the same channel.
  folder.write("roundel.yaml", small_arena(kPort, 2, "marker: {bits: 6}\ncamera: {name: east}\n"));
  daemon.signal(SIGHUP);
  REQUIRE(daemon.wait_for("changed", kPatience));
  frame = wait_for_frame(subscriber, [&](const ReceivedFrame& f) {
    return f.header.session != session && f.markers.size() == 2;
  });
  REQUIRE(frame != nullptr);
  CHECK(frame->camera == "east");

  daemon.signal(SIGHUP);
  CHECK(daemon.wait_for("nothing has changed", kPatience));
  daemon.signal(SIGTERM);
  CHECK(daemon.wait(kPatience) == 0);
}

TEST_CASE("roundeld started before the network waits for it") {
  if (!multicast_is_private()) return;
  // A network namespace of its own that has no route yet; unshare becomes roundeld.
  ChildProcess daemon({"/usr/bin/unshare", "-n", ROUNDELD_BINARY, "--set", "simulator.width=320",
                       "--set", "simulator.height=240", "--set", "simulator.clutter=false"});
  REQUIRE(daemon.wait_for("trying again", kPatience));
  CHECK(daemon.errors().find("no route to the multicast group 239.255.76.67") != std::string::npos);
  const std::string inside = "nsenter -n -t " + std::to_string(daemon.pid()) + " ip ";
  REQUIRE(std::system((inside + "link set lo up").c_str()) == 0);
  REQUIRE(std::system((inside + "route add 239.0.0.0/8 dev lo").c_str()) == 0);
  CHECK(daemon.wait_for("the network is there", kPatience));
  daemon.signal(SIGTERM);
  CHECK(daemon.wait(kPatience) == 0);
}

TEST_CASE("roundeld waits for a camera that is not there, and says so to its subscribers") {
  if (!multicast_is_private()) return;
  constexpr int kPort = 7705;
  Subscriber subscriber(url(kPort), "ROUNDEL");
  ChildProcess daemon({ROUNDELD_BINARY, "--set", "source=camera", "--set",
                       "camera.device=/dev/v4l/by-id/none", "--set", "lcm.url=" + url(kPort)});
  CHECK(daemon.wait_for("no camera is at /dev/v4l/by-id/none", kPatience));
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  while (!subscriber.status() && std::chrono::steady_clock::now() < deadline) {
    CHECK(subscriber.next_frame(100ms) == nullptr);
  }
  REQUIRE(subscriber.status().has_value());
  CHECK(subscriber.status()->camera_state == header_t::CAMERA_STARTING);
  CHECK(subscriber.status()->simulated == 0);
  daemon.signal(SIGTERM);
  CHECK(daemon.wait(kPatience) == 0);
}

TEST_CASE("a recording is sent frame by frame to its end") {
  if (!multicast_is_private()) return;
  constexpr int kPort = 7704;
  const TemporaryDirectory folder;
  std::string video = "YUV4MPEG2 W32 H32 F30:1 Cmono\n";
  for (int i = 0; i < 20; ++i) video += "FRAME\n" + std::string(32 * 32, 'x');
  const std::string path = folder.write("a.y4m", video);
  Subscriber subscriber(url(kPort), "ROUNDEL");
  ChildProcess daemon({ROUNDELD_BINARY, "--set", "source=files", "--set",
                       "files.paths=[" + path + "]", "--set", "files.frame_rate=100", "--set",
                       "lcm.url=" + url(kPort)});
  for (std::int64_t number = 0; number < 20; ++number) {
    const ReceivedFrame* frame = wait_for_frame(subscriber, [](const auto&) { return true; });
    REQUIRE(frame != nullptr);
    REQUIRE(frame->header.frame == number);
    CHECK(frame->header.calibration_state == header_t::CALIBRATION_NONE);
  }
  CHECK(daemon.wait(kPatience) == 0);
}

TEST_CASE("more markers than may be reported are told once, and the others go out") {
  if (!multicast_is_private()) return;
  constexpr int kPort = 7709;
  const TemporaryDirectory folder;
  Subscriber subscriber(url(kPort), "ROUNDEL");
  ChildProcess daemon(command(folder.write(
      "roundel.yaml",
      small_arena(kPort, 4, "detector: {max_markers: 2}\ncontrol: {socket: \"\"}\n"))));
  CHECK(daemon.wait_for("2 markers are in view: detector.max_markers", kPatience));
  CHECK(wait_for_frame(subscriber, [](const ReceivedFrame& f) { return f.markers.size() == 2; }) !=
        nullptr);
}

// Nothing that could be a camera is at a pipe, and opening one would hang.
TEST_CASE("roundeld waits for a camera that is not there, through reloads, and ends at SIGTERM") {
  if (!multicast_is_private()) return;
  constexpr int kPort = 7708;
  const TemporaryDirectory folder;
  const std::string pipe = folder.file("pipe");
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  const auto config = [&](const std::string& more) {
    return "source: camera\ncamera: {device: " + pipe + more + "}\nlcm: {url: \"" + url(kPort) +
           "\"}\ncontrol: {socket: \"\"}\n";
  };
  Subscriber subscriber(url(kPort), "ROUNDEL");
  ChildProcess daemon(command(folder.write("roundel.yaml", config(""))));
  REQUIRE(daemon.wait_for("no camera is at " + pipe, kPatience));
  folder.write("roundel.yaml", config(", controls: {gain: 3}"));
  daemon.signal(SIGHUP);
  REQUIRE(daemon.wait_for("reloaded: camera.controls changed", kPatience));
  folder.write("roundel.yaml", config(", format: MJPG"));
  daemon.signal(SIGHUP);
  REQUIRE(daemon.wait_for("reloaded: camera.format, camera.controls changed", kPatience));
  REQUIRE(daemon.wait_for("no camera is at " + pipe, kPatience));
  folder.write("roundel.yaml", config(", format: PINK"));
  daemon.signal(SIGHUP);
  REQUIRE(daemon.wait_for("the configuration in use stays", kPatience));
  folder.write("roundel.yaml", "source: files\nfiles: {paths: [" + pipe + "]}\n");
  daemon.signal(SIGHUP);
  REQUIRE(
      daemon.wait_for("neither a file nor a folder; the configuration in use stays", kPatience));
  folder.write("roundel.yaml", "");
  daemon.signal(SIGHUP);
  REQUIRE(daemon.wait_for("stands for the defaults; the configuration in use stays", kPatience));
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  while (!subscriber.status() && std::chrono::steady_clock::now() < deadline) {
    CHECK(subscriber.next_frame(1s) == nullptr);
  }
  REQUIRE(subscriber.status().has_value());
  CHECK(subscriber.status()->camera_state == header_t::CAMERA_STARTING);
  CHECK(subscriber.status()->width == 0);
  daemon.signal(SIGTERM);
  CHECK(daemon.wait(kPatience) == 0);
}
