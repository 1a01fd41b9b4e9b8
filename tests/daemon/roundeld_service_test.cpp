// roundeld as a service: what it tells the manager that started it, and when.
#include <doctest/doctest.h>
#include <algorithm>
#include <csignal>

#include "tests/child_process.hpp"
#include "tests/daemon/notify_socket.hpp"
#include "tests/private_network.hpp"
#include "tests/temporary_directory.hpp"

using namespace roundel;
using namespace std::chrono_literals;

namespace {

constexpr auto kPatience = 60s;  // sanitizers are slow
using Lines = std::vector<std::string>;

// With a port of its own for every test, so that they may run side by side.
std::vector<std::string> started_by(const NotifySocket& systemd, int port, int watchdog_ms,
                                    const std::vector<std::string>& settings) {
  Lines command = {"/usr/bin/env", "NOTIFY_SOCKET=" + systemd.path(),
                   "WATCHDOG_USEC=" + std::to_string(watchdog_ms * 1000), ROUNDELD_BINARY};
  Lines all = {"control.socket=",
               "lcm.url=udpm://239.255.76.69:" + std::to_string(port) + "?ttl=0"};
  all.insert(all.end(), settings.begin(), settings.end());
  for (const std::string& setting : all) command.insert(command.end(), {"--set", setting});
  return command;
}

const Lines kSmallArena = {"simulator.width=320",     "simulator.height=240",
                           "simulator.robots=0",      "simulator.corner_markers=false",
                           "simulator.clutter=false", "simulator.frame_rate=20"};

long count(const Lines& messages, const std::string& text) {
  return std::count(messages.begin(), messages.end(), text);
}

}  // namespace

TEST_CASE("it is ready after its first frame, lives by its frames, and says that it stops") {
  if (!multicast_is_private()) return;
  NotifySocket systemd;
  ChildProcess daemon(started_by(systemd, 7711, 400, kSmallArena));
  const Lines start = systemd.receive_until("READY=1", kPatience);
  REQUIRE_FALSE(start.empty());
  // The summary is written at the first frame.
  CHECK(daemon.wait_for("TTL 0, by interface lo", 1s));
  CHECK(start[start.size() - 2].starts_with("STATUS=Tracking simulator 320x240"));
  CHECK_FALSE(systemd.receive_until("WATCHDOG=1", kPatience).empty());
  CHECK_FALSE(systemd.receive_until("WATCHDOG=1", kPatience).empty());
  daemon.signal(SIGTERM);
  CHECK_FALSE(systemd.receive_until("STOPPING=1", kPatience).empty());
  CHECK(daemon.wait(kPatience) == 0);
}

TEST_CASE("it is ready and lives while it waits for a camera that is not there") {
  if (!multicast_is_private()) return;
  NotifySocket systemd;
  ChildProcess daemon(
      started_by(systemd, 7712, 400, {"source=camera", "camera.device=/dev/v4l/by-id/none"}));
  const Lines start = systemd.receive_until("READY=1", kPatience);
  REQUIRE_FALSE(start.empty());
  CHECK(start[start.size() - 2].starts_with(
      "STATUS=Waits for the camera: no camera is at /dev/v4l/by-id/none"));
  for (int i = 0; i < 3; ++i) {
    const Lines wait = systemd.receive_until("WATCHDOG=1", kPatience);
    CHECK_FALSE(wait.empty());
    CHECK(count(wait, "READY=1") == 0);
  }
  daemon.signal(SIGTERM);
  CHECK(daemon.wait(kPatience) == 0);
}

TEST_CASE("between frames that come seldom it lives by waiting for the next") {
  if (!multicast_is_private()) return;
  NotifySocket systemd;
  Lines settings = kSmallArena;
  settings.push_back("simulator.frame_rate=0.1");
  ChildProcess daemon(started_by(systemd, 7713, 200, settings));
  REQUIRE_FALSE(systemd.receive_until("READY=1", kPatience).empty());
  for (int i = 0; i < 10; ++i) CHECK_FALSE(systemd.receive_until("WATCHDOG=1", kPatience).empty());
  daemon.signal(SIGTERM);
  CHECK(daemon.wait(kPatience) == 0);
}

TEST_CASE("a reload is told, and a failed one with its reason") {
  if (!multicast_is_private()) return;
  NotifySocket systemd;
  const TemporaryDirectory folder;
  const std::string file = folder.write("a.yaml", "simulator: {seed: 1}\n");
  Lines command = started_by(systemd, 7714, 0, kSmallArena);
  command.insert(command.end(), {"--config", file});
  ChildProcess daemon(command);
  REQUIRE_FALSE(systemd.receive_until("READY=1", kPatience).empty());

  folder.write("a.yaml", "simulator: {seed: many}\n");
  daemon.signal(SIGHUP);
  CHECK_FALSE(systemd.receive_until("RELOADING=1\nMONOTONIC_USEC=", kPatience).empty());
  Lines rest = systemd.receive_until("READY=1", kPatience);
  REQUIRE(rest.size() == 2);
  CHECK(rest[0].find("the last reload failed: " + file + ":1:19: simulator.seed") !=
        std::string::npos);

  folder.write("a.yaml", "simulator: {seed: 2}\n");
  daemon.signal(SIGHUP);
  CHECK_FALSE(systemd.receive_until("RELOADING=1\nMONOTONIC_USEC=", kPatience).empty());
  rest = systemd.receive_until("READY=1", kPatience);
  REQUIRE_FALSE(rest.empty());
  CHECK(rest[0].find("reload failed") == std::string::npos);
  daemon.signal(SIGTERM);
  CHECK(daemon.wait(kPatience) == 0);
}
