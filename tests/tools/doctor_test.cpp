// Every check of `roundel doctor`, with machines that are well and machines that are not.
#include <doctest/doctest.h>
#include <net/if.h>

#include <cerrno>
#include <filesystem>

#include "calibration/camera_file.hpp"
#include "tests/private_network.hpp"
#include "tests/tools/run_roundel.hpp"
#include "tools/doctor/calibration_checks.hpp"
#include "tools/doctor/daemon_checks.hpp"
#include "tools/doctor/machine_checks.hpp"
#include "tools/doctor/network_checks.hpp"

using namespace roundel;

namespace {

// A machine of files.
class Machine {
 public:
  void put(const std::string& path, const std::string& text) const {
    const std::filesystem::path file(folder_.file(path.substr(1)));
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file) << text << "\n";
  }
  MachineRoot root() const { return {folder_.file("")}; }
  std::string path(const std::string& name) const { return folder_.file(name); }

 private:
  TemporaryDirectory folder_;
};

LcmSettings settings(const std::string& url, const std::string& interface_name = "") {
  LcmSettings settings;
  settings.url = url;
  settings.interface_name = interface_name;
  return settings;
}

const LcmSettings kOut = settings("udpm://239.255.76.67:7667?ttl=1");

void check_finding(const Finding& finding, Verdict verdict, const std::string& text,
                   const std::string& remedy = "") {
  CAPTURE(finding.text);
  CAPTURE(finding.remedy);
  CHECK(finding.verdict == verdict);
  CHECK(contains(finding.text, text));
  CHECK(contains(finding.remedy, remedy));
  // Who is told of trouble is told what to do.
  CHECK((finding.verdict == Verdict::kOk) == finding.remedy.empty());
}

}  // namespace

TEST_CASE("doctor: poses that stay on the machine are pointed out") {
  check_finding(check_url(settings("udpm://239.255.76.67:7667?ttl=0")), Verdict::kWarning, "ttl=0",
                "?ttl=1");
  check_finding(check_url(kOut), Verdict::kOk, "poses go to udpm://239");
  check_finding(check_url(settings("memq://")), Verdict::kWarning, "reaches no robot", "ttl=1");
  LcmSettings copies = settings("udpm://239.255.76.67:7667?ttl=0");
  copies.copies = {"udpm://10.0.0.2:7667"};
  check_finding(check_url(copies), Verdict::kOk, "and 1 copies");
}

TEST_CASE("doctor: the route") {
  check_finding(check_route(kOut, {0, "eth0", "10.0.0.1"}), Verdict::kOk,
                "239.255.76.67 goes to eth0");
  check_finding(check_route(kOut, {ENETUNREACH, "", ""}), Verdict::kProblem, "no route",
                "ip route add 239.0.0.0/8 dev INTERFACE");
  check_finding(check_route(settings(kOut.url, "wlan0"), {ENETUNREACH, "", ""}), Verdict::kWarning,
                "programs on this machine can't receive", "dev wlan0");
  check_finding(check_route(kOut, {0, "lo", ""}), Verdict::kWarning, "goes to lo", "lcm.interface");
  check_finding(check_route(settings("udpm://10.0.0.2:7667"), {ENETUNREACH, "", ""}),
                Verdict::kProblem, "no way to 10.0.0.2", "ip route");
  check_finding(check_route(settings("memq://"), {}), Verdict::kOk, "none is needed");
}

TEST_CASE("doctor: the interface") {
  const Machine machine;
  const Route route{0, "eth0", "10.0.0.1"};
  check_finding(check_interface(machine.root(), kOut, route), Verdict::kProblem,
                "no network interface eth0", "ip link");
  machine.put("/sys/class/net/eth0/flags", "0x1003");
  machine.put("/sys/class/net/eth0/carrier", "1");
  check_finding(check_interface(machine.root(), kOut, route), Verdict::kOk, "eth0 is up");
  machine.put("/sys/class/net/eth0/carrier", "0");
  check_finding(check_interface(machine.root(), kOut, route), Verdict::kProblem, "no cable",
                "plug it in");
  machine.put("/sys/class/net/eth0/flags", "0x1002");
  check_finding(check_interface(machine.root(), kOut, route), Verdict::kProblem, "is down",
                "ip link set eth0 up");
  machine.put("/sys/class/net/eth0/flags", "0x3");
  machine.put("/sys/class/net/eth0/carrier", "1");
  check_finding(check_interface(machine.root(), kOut, route), Verdict::kProblem,
                "multicast turned off", "multicast on");
  machine.put("/sys/class/net/wlan0/flags", "0x1003");
  machine.put("/sys/class/net/wlan0/phy80211/name", "phy0");
  check_finding(check_interface(machine.root(), settings(kOut.url, "wlan0"), route),
                Verdict::kWarning, "wlan0 is Wi-Fi", "lcm.copies");
}

TEST_CASE("doctor: firewalls") {
  const Machine clean, ufw, firewalld, nftables;
  check_finding(check_firewall(clean.root(), kOut), Verdict::kOk, "neither ufw");
  ufw.put("/etc/ufw/ufw.conf", "# settings\nENABLED=yes");
  check_finding(check_firewall(ufw.root(), kOut), Verdict::kWarning, "ufw is on",
                "to 239.255.76.67 port 7667");
  firewalld.put("/run/firewalld/x", "");
  check_finding(check_firewall(firewalld.root(), kOut), Verdict::kWarning, "firewalld",
                "--add-port=7667/udp");
  nftables.put("/etc/systemd/system/sysinit.target.wants/nftables.service", "");
  check_finding(check_firewall(nftables.root(), kOut), Verdict::kOk, "");
  nftables.put("/etc/nftables.conf", "chain input { policy drop; }");
  check_finding(check_firewall(nftables.root(), kOut), Verdict::kWarning, "drops packets",
                "udp dport 7667 accept");
}

TEST_CASE("doctor: receive buffers against the size of a frame") {
  const Machine machine;
  machine.put("/proc/sys/net/core/rmem_default", "212992");
  machine.put("/proc/sys/net/core/rmem_max", "212992");
  machine.put("/proc/net/snmp",
              "Udp: InDatagrams NoPorts RcvbufErrors\nUdp: 10 2 0\nUdpLite: a b\n"
              "UdpLite: 0 9");
  check_finding(check_buffers(machine.root(), 30), Verdict::kOk, "212992");
  check_finding(check_buffers(machine.root(), 1000), Verdict::kWarning, "4 frames of 1000 markers",
                "net.core.rmem_max=");
  machine.put("/proc/net/snmp", "Udp: InDatagrams NoPorts RcvbufErrors\nUdp: 10 2 31");
  check_finding(check_buffers(machine.root(), 30), Verdict::kWarning, "31 datagrams",
                "rmem_default");
}

TEST_CASE("doctor: the way back to this machine is tried") {
  check_finding(check_loopback(settings("memq://"), std::chrono::milliseconds(1)), Verdict::kOk,
                "not tried");
  if (!multicast_is_private()) return;
  check_finding(check_loopback(settings("udpm://239.255.76.71:7672?ttl=1"),
                               std::chrono::milliseconds(10'000)),
                Verdict::kOk, "comes back");
  check_finding(check_loopback(settings("udpm://239.255.76.71:7672?ttl=1", "nosuch0"),
                               std::chrono::milliseconds(1)),
                Verdict::kProblem, "no network interface nosuch0", "interface above");
  // 225.0.0.0/8 has no route in the private network.
  check_finding(check_loopback(settings("udpm://225.1.1.1:7672"), std::chrono::milliseconds(1)),
                Verdict::kProblem, "no route to the multicast group", "route");
}

TEST_CASE("doctor: the clock and what keeps it") {
  const Machine machine;
  check_finding(check_clock(machine.root(), ClockState::kFreeRunning), Verdict::kWarning,
                "not synchronised", "install chrony");
  check_finding(check_clock(machine.root(), ClockState::kSynchronised), Verdict::kOk,
                "synchronised");
  machine.put("/run/chrony/chronyd.pid", "1");
  check_finding(check_clock(machine.root(), ClockState::kSynchronised), Verdict::kOk, "by chrony");
  check_finding(check_clock(machine.root(), ClockState::kFreeRunning), Verdict::kWarning,
                "although chrony runs", "chronyc sources");
}

TEST_CASE("doctor: groups, disk, temperature") {
  check_finding(check_groups({"users"}, "roundel", false), Verdict::kWarning,
                "not a member of video and roundel", "usermod -aG video,roundel");
  check_finding(check_groups({"video", "roundel"}, "roundel", false), Verdict::kOk, "");
  check_finding(check_groups({}, "roundel", true), Verdict::kOk, "");
  check_finding(check_disk({"/var/lib", 7'000'000'000}), Verdict::kOk, "7.0 GB");
  check_finding(check_disk({"/var/lib", 50'000'000}), Verdict::kWarning, "50 MB", "make room");
  check_finding(check_disk({"/var/lib", 900'000}), Verdict::kProblem, "0 MB", "make room");
  const Machine machine;
  check_finding(check_temperature(machine.root()), Verdict::kOk, "does not tell");
  machine.put("/sys/class/thermal/thermal_zone0/temp", "48312");
  check_finding(check_temperature(machine.root()), Verdict::kOk, "48 degrees");
  machine.put("/sys/class/thermal/thermal_zone1/temp", "83500");
  check_finding(check_temperature(machine.root()), Verdict::kWarning, "84 degrees", "fan");
}

TEST_CASE("doctor: a Raspberry Pi that slows itself down") {
  const Machine machine;
  const auto throttled = [&](const std::string& state) {
    machine.put("/sys/devices/platform/soc/soc:firmware/get_throttled", state);
    return check_throttling(machine.root()).at(0);
  };
  CHECK(check_throttling(machine.root()).empty());  // another machine
  check_finding(throttled("0"), Verdict::kOk, "full speed");
  check_finding(throttled("50005"), Verdict::kProblem, "too little voltage, throttling", "5.1 V");
  check_finding(throttled("80000"), Verdict::kWarning, "has had a soft limit", "fan");
}

TEST_CASE("doctor: the lens") {
  const Machine machine;
  const auto now = std::chrono::system_clock::now();
  Configuration values;
  check_finding(check_lens(values, 0, 0, now), Verdict::kOk, "simulator");
  values.source = SourceKind::kCamera;
  check_finding(check_lens(values, 0, 0, now), Verdict::kProblem, "no poses", "calibrate camera");
  values.camera.calibration = machine.path("camera.yaml");
  check_finding(check_lens(values, 0, 0, now), Verdict::kProblem, "No such file", "calibrate");
  CameraModel camera;
  camera.width = 640;
  camera.height = 480;
  camera.fx = camera.fy = 500;
  camera.cx = 320;
  camera.cy = 240;
  write_camera_file(values.camera.calibration, {"x", camera});
  check_finding(check_lens(values, 640, 480, now), Verdict::kOk, "640x480, 0 days old");
  check_finding(check_lens(values, 1920, 1080, now), Verdict::kProblem, "1920x1080", "calibrate");
  check_finding(check_lens(values, 640, 480, now + std::chrono::hours(24 * 400)), Verdict::kWarning,
                "400 days old", "if focus");
  values.arena.file = machine.path("arena.yaml");
  check_finding(check_arena(values), Verdict::kOk, "not calibrated");
  machine.put("/arena.yaml", "nonsense: [");
  check_finding(check_arena(values), Verdict::kProblem, "arena.yaml:", "calibrate arena");
}

TEST_CASE("doctor: what a running roundeld says of itself") {
  Configuration values;
  values.simulator.frame_rate = 30;
  nlohmann::ordered_json status = {
      {"camera", {{"state", "streaming"}, {"source", "simulator 640x480"}}},
      {"frame_rate", 29.9},
      {"frames", 1000},
      {"dropped", 0},
      {"unsent", 0},
      {"arena", {{"state", "valid"}}}};
  for (const Finding& finding : check_status(status, values)) {
    check_finding(finding, Verdict::kOk, "");
  }
  status["camera"]["state"] = "lost";
  check_finding(check_status(status, values)[0], Verdict::kProblem, "no frames come", "journalctl");
  status["frame_rate"] = 15;
  check_finding(check_status(status, values)[1], Verdict::kWarning, "15.0 a second of 30 wanted",
                "exposure");
  status["frame_rate"] = 30;
  status["dropped"] = 400;
  check_finding(check_status(status, values)[1], Verdict::kWarning, "400 of 1400", "too slow");
  status["unsent"] = 3;
  check_finding(check_status(status, values)[2], Verdict::kWarning, "3 of 1000", "route");
  status["unsent"] = 1000;
  check_finding(check_status(status, values)[2], Verdict::kProblem, "1000 of 1000", "route");
  status["arena"] = {{"state", "moved"}};
  check_finding(check_status(status, values)[3], Verdict::kProblem, "moved", "calibrate arena");
}

TEST_CASE("doctor works without a roundeld, and ends with 1 where there is a problem") {
  const TemporaryDirectory folder;
  const std::string config = folder.write(
      "roundel.yaml", "lcm: {url: \"udpm://239.255.76.71:7673?ttl=1\", interface: nosuch0}\n");
  const CommandResult result =
      run_roundel("doctor --json --socket " + folder.file("none.sock") + " --config " + config);
  CHECK(result.status == 1);
  CHECK(contains(result.err, "problems found"));
  bool interface_told = false;
  for (const nlohmann::json& line : json_lines(result.out)) {
    CHECK_FALSE(line["check"].get<std::string>().empty());
    interface_told =
        interface_told || (line["check"] == "interface" && line["verdict"] == "problem");
  }
  CHECK(interface_told);
  const CommandResult broken = run_roundel("doctor --socket " + folder.file("none.sock") +
                                           " --config " + folder.write("bad.yaml", "lcm: 7\n"));
  CHECK(broken.status == 1);
  CHECK(contains(broken.out, "problem  configuration"));
}
