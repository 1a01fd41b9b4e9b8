// A machine above an arena, with the package installed, that has been switched on. Nobody logs in
// but to look and to break things. The tests are in order, and each leaves a machine that works.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <memory>

#include "tests/boot/installed_service.hpp"
#include "tests/boot/robot.hpp"
#include "tests/lab/report.hpp"
#include "tests/lab/usb_camera.hpp"
#include "tests/temporary_directory.hpp"
#include "transport/clock.hpp"

using namespace roundel;

namespace {

const std::string kConfiguration = "/etc/roundel/roundel.yaml";

UsbCameraDescription description(const std::string& serial) {
  UsbCameraDescription camera;
  camera.formats = {UsbFormat::kGrey};
  camera.serial = serial;
  return camera;
}

// The camera above the arena: plugged in by the first test that needs it.
UsbCamera& camera() {
  static UsbCamera it(Film::shared(), description("ARENA"));
  return it;
}

InstalledService& service() {
  static InstalledService it("roundeld.service");
  return it;
}

Robot& robot() {
  static Robot it;
  return it;
}

std::string ms(std::int64_t from_us, std::int64_t to_us) {
  return fmt::format("{} ms", (to_us - from_us) / 1000);
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::string last_line(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text.substr(text.rfind('\n') + 1);
}

void append(const std::string& file, const std::string& text) {
  std::ofstream(file, std::ios::app) << text;
}

// The configuration as it is now, put back at the end.
class ConfigurationGuard {
 public:
  ~ConfigurationGuard() { std::ofstream(kConfiguration) << before_; }

 private:
  std::string before_ = read_file(kConfiguration);
};

}  // namespace

TEST_CASE("switched on without a camera, the service is up and says what it waits for") {
  CHECK(comes_true([] { return service().is_active(); }));
  CHECK(comes_true(
      [] { return contains(service().status(), "there is no camera that can capture"); }));
  CHECK(service().status().starts_with("Waits for the camera: "));
  CHECK(contains(service().log(4), "no frames yet: there is no camera that can capture"));
  CHECK(service().restarts() == 0);
  report(fmt::format("switched on: ready {} after its start, without a camera: \"{}\"",
                     ms(service().started_us(), service().number("ActiveEnterTimestampMonotonic")),
                     service().status()));
}

TEST_CASE("a camera is plugged in, and poses reach the robot over the network") {
  robot();
  const std::int64_t plugged_us = now().mono_us;
  camera();
  const auto poses_us = robot().poses_after(plugged_us);
  INFO(service().log());
  REQUIRE(poses_us.has_value());
  CHECK(robot().header().simulated == 0);
  CHECK(comes_true([] { return service().status().starts_with("Tracking "); }));
  const std::string log = service().log();
  CHECK(contains(log, "serial ARENA"));
  CHECK(contains(log, "controls: as the camera has them"));
  CHECK(contains(log, "lens: /etc/roundel/camera.yaml, "));
  CHECK(contains(log, "TTL 1, by interface arena0 (10.77.0.1)"));
  report(fmt::format("camera plugged in: poses at the robot {} later; \"{}\"",
                     ms(plugged_us, *poses_us), service().status()));
}

TEST_CASE("the USB camera is not put to sleep") {
  const std::filesystem::path device =
      std::filesystem::canonical("/sys/class/video4linux/video0/device/..");
  CHECK(comes_true([&] { return read_file(device / "power/control") == "on\n"; }));
}

TEST_CASE("the sandbox holds: no capability, no other device, nothing written elsewhere") {
  const std::string folder = fmt::format("/proc/{}/", service().pid());
  const std::string status = read_file(folder + "status");
  CHECK(contains(status, "CapEff:\t0000000000000000"));
  CHECK(contains(status, "CapBnd:\t0000000000000000"));
  CHECK(contains(status, "NoNewPrivs:\t1"));
  CHECK(contains(status, "Seccomp:\t2"));
  // Even for root, in the service's cgroup and mounts.
  const auto inside = [&](const std::string& command) {
    const std::string enter = fmt::format(
        "echo $$ >/sys/fs/cgroup/system.slice/roundeld.service/cgroup.procs; exec nsenter -m -t {} "
        "/bin/sh -c '{}'",
        service().pid(), command);
    return run_program({"/bin/sh", "-c", enter}).status;
  };
  CHECK(inside("exec 3<>/dev/null") == 0);
  CHECK(inside("exec 3<>/dev/video0") == 0);
  CHECK(run_program({"/bin/sh", "-c", "exec 3<>/dev/kmsg"}).status == 0);
  CHECK(inside("exec 3<>/dev/kmsg") != 0);
  CHECK(inside("touch /var/lib/roundel/there") == 0);
  CHECK(inside("touch /etc/roundel.here") != 0);
  CHECK(inside("touch /var/tmp/../lib/here") != 0);
}

TEST_CASE("killed, it is back within seconds") {
  const std::int64_t restarts = service().restarts();
  const std::int64_t killed_us = now().mono_us;
  service().signal("KILL");
  REQUIRE(
      comes_true([&] { return service().restarts() == restarts + 1 && service().is_active(); }));
  const auto poses_us = robot().poses_after(service().started_us());
  REQUIRE(poses_us.has_value());
  report(fmt::format("SIGKILL: poses again {} later", ms(killed_us, *poses_us)));
}

TEST_CASE("a loop that stands still is ended by the watchdog, and poses come back") {
  const std::int64_t restarts = service().restarts();
  service().forget_log();
  const std::int64_t stopped_us = now().mono_us;
  service().signal("STOP");
  REQUIRE(
      comes_true([&] { return service().restarts() == restarts + 1 && service().is_active(); }));
  const auto poses_us = robot().poses_after(service().started_us());
  REQUIRE(poses_us.has_value());
  CHECK(contains(service().log(), "Watchdog timeout"));
  report(fmt::format("stalled loop: ended by the watchdog, poses again {} later",
                     ms(stopped_us, *poses_us)));
}

TEST_CASE("a broken configuration is refused at reload with its place, and poses go on") {
  const ConfigurationGuard guard;
  service().forget_log();
  const int pid = service().pid();
  append(kConfiguration, "simulator: {robots: many}\n");
  CHECK(service().systemctl("reload") != 0);
  CHECK(comes_true([] { return contains(service().log(3), kConfiguration + ":"); }));
  CHECK(service().is_active());
  CHECK(robot().poses_now().has_value());
  // Without systemctl's check before it.
  service().signal("HUP");
  CHECK(comes_true(
      [] { return contains(service().status(), "the last reload failed: " + kConfiguration); }));
  CHECK(robot().poses_now().has_value());
  CHECK(service().pid() == pid);
  report(fmt::format("broken configuration at reload: {}", service().status()));
}

TEST_CASE("a right configuration takes effect at reload") {
  const int pid = service().pid();
  {
    const ConfigurationGuard guard;
    std::string text = read_file(kConfiguration);
    const std::string name = "\n  name: camera ";
    text.replace(text.find(name), name.size(), "\n  name: ceiling ");
    std::ofstream(kConfiguration) << text;
    CHECK(service().systemctl("reload") == 0);
    CHECK(comes_true(
        [] { return robot().poses_now().has_value() && robot().camera() == "ceiling"; }));
  }
  CHECK(service().systemctl("reload") == 0);
  CHECK(comes_true([] { return robot().poses_now().has_value() && robot().camera() == "camera"; }));
  CHECK_FALSE(contains(service().status(), "reload"));
  CHECK(service().pid() == pid);
}

TEST_CASE("a broken configuration at the start is told, not tried again and again") {
  {
    const ConfigurationGuard guard;
    service().forget_log();
    append(kConfiguration, "lcm: {ttl: 1}\n");
    CHECK(service().systemctl("restart") != 0);
    CHECK(service().property("ActiveState") == "failed");
    CHECK(service().property("ExecMainStatus") == "2");
    CHECK(comes_true([] { return contains(service().log(3), kConfiguration + ":"); }));
  }
  CHECK(service().systemctl("start") == 0);
  CHECK(robot().poses_now().has_value());
}

TEST_CASE("a full disk is told by the calibration that can't be kept; poses go on") {
  REQUIRE(run_program({"/bin/mount", "-t", "tmpfs", "-o",
                       "size=16k,mode=0755,uid=roundel,gid=roundel", "full", "/var/lib/roundel"})
              .status == 0);
  REQUIRE(service().systemctl("restart") == 0);
  run_program({"/bin/dd", "if=/dev/zero", "of=/var/lib/roundel/fill", "bs=1k"});
  const std::vector<std::string> calibrate = {
      "/usr/bin/roundel", "calibrate", "arena",        "--width", "3",
      "--height",         "2",         "--time-limit", "20"};
  const Finished full = run_program(calibrate);
  CAPTURE(full.output);
  CHECK(full.status == 1);
  CHECK(contains(full.errors, "No space left on device"));
  CHECK(robot().poses_now().has_value());
  CHECK(service().systemctl("restart") == 0);
  CHECK(robot().poses_now().has_value());
  report(fmt::format("full disk: {}", last_line(full.errors)));

  std::filesystem::remove("/var/lib/roundel/fill");
  const Finished room = run_program(calibrate);
  CAPTURE(room.errors);
  CHECK(room.status == 0);
  CHECK(comes_true([] { return robot().poses_now().has_value() && robot().in_arena(); }));
  service().systemctl("stop");
  CHECK(run_program({"/bin/umount", "/var/lib/roundel"}).status == 0);
  CHECK(service().systemctl("start") == 0);
}

TEST_CASE("from the start of the service to the first pose") {
  REQUIRE(service().systemctl("restart") == 0);
  const std::int64_t started_us = service().started_us();
  const auto poses_us = robot().poses_after(started_us);
  REQUIRE(poses_us.has_value());
  report(fmt::format("power-on of the service: first pose {} after the start of its program",
                     ms(started_us, *poses_us)));
}

TEST_CASE("a camera with a name starts an instance of its own, with its own socket") {
  InstalledService east("roundeld@east.service");
  CHECK_FALSE(east.is_active());
  Robot listener("EAST");
  const UsbCamera second(Film::shared(), description("EAST"), 1);
  REQUIRE(comes_true([&] { return east.is_active(); }));
  INFO(east.log());
  REQUIRE(listener.poses_now().has_value());
  CHECK(listener.camera() == "east");
  CHECK(std::filesystem::is_symlink("/dev/roundel/east"));
  CHECK(std::filesystem::is_socket("/run/roundel/east/control.sock"));
  CHECK(std::filesystem::is_socket("/run/roundel/control.sock"));
  CHECK(robot().poses_now().has_value());
  CHECK(robot().camera() == "camera");
  CHECK(service().systemctl("restart") == 0);
  CHECK(std::filesystem::is_socket("/run/roundel/east/control.sock"));
  CHECK(east.systemctl("stop") == 0);
}

TEST_CASE("the real-time drop-in gives the frame loop, and it alone, its priority") {
  const std::string folder = "/etc/systemd/system/roundeld.service.d";
  std::filesystem::create_directories(folder);
  std::filesystem::copy_file("/usr/share/doc/roundel/examples/realtime.conf",
                             folder + "/realtime.conf");
  run_program({"/usr/bin/systemctl", "daemon-reload"});
  REQUIRE(service().systemctl("restart") == 0);
  CHECK(robot().poses_now().has_value());
  const std::string process = fmt::format("/proc/{}/", service().pid());
  const auto policy = [](const std::string& thread) {
    return run_program({"/usr/bin/chrt", "-p", thread}).output;
  };
  CHECK(contains(policy(std::to_string(service().pid())), "SCHED_FIFO"));
  int others = 0;
  for (const auto& thread : std::filesystem::directory_iterator(process + "task")) {
    const std::string id = thread.path().filename();
    if (id == std::to_string(service().pid())) continue;
    CHECK(contains(policy(id), "SCHED_OTHER"));
    ++others;
  }
  CHECK(others > 0);
  CHECK_FALSE(contains(read_file(process + "status"), "VmLck:\t       0 kB"));
}

TEST_CASE("all of it said nothing that repeats with every frame") {
  const InstalledService whole("roundeld.service");
  const std::string log = whole.log();
  const auto lines = std::count(log.begin(), log.end(), '\n');
  report(
      fmt::format("{} lines in the journal in {} s of all this", lines, now().mono_us / 1'000'000));
  CHECK(lines < 400);
}
