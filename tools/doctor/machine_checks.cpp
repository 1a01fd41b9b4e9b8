#include "tools/doctor/machine_checks.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>

namespace roundel {
namespace {

namespace fs = std::filesystem;

std::string clock_program(const MachineRoot& root) {
  if (root.exists("/run/chrony")) return "chrony";
  if (root.exists("/run/systemd/timesync")) return "systemd-timesyncd";
  if (root.exists("/run/ntpd.pid") || root.exists("/run/ntpsec")) return "ntpd";
  if (root.exists("/run/ptp4l")) return "ptp4l";
  return "";
}

// Bits of get_throttled, as the Raspberry Pi's documentation has them.
struct ThrottleBit {
  unsigned bit;
  const char* what;
};
constexpr std::array kThrottleBits = {
    ThrottleBit{0, "too little voltage"}, ThrottleBit{1, "a limited clock"},
    ThrottleBit{2, "throttling"}, ThrottleBit{3, "a soft limit of temperature"}};
constexpr unsigned kSinceStart = 16;  // the same bits, higher by this, tell of the past

std::string throttle_text(unsigned long state, unsigned shift) {
  std::vector<std::string> words;
  for (const ThrottleBit& bit : kThrottleBits) {
    if ((state >> (bit.bit + shift) & 1) != 0) words.emplace_back(bit.what);
  }
  return fmt::format("{}", fmt::join(words, ", "));
}

}  // namespace

Finding check_clock(const MachineRoot& root, ClockState state) {
  const std::string program = clock_program(root);
  if (state == ClockState::kSynchronised) {
    return {"clock", Verdict::kOk,
            program.empty() ? "synchronised" : fmt::format("synchronised, by {}", program), ""};
  }
  if (program.empty()) {
    return {"clock", Verdict::kWarning,
            "not synchronised, so the time of a pose means nothing on other machines",
            "sudo apt-get install chrony, here and on the robots (docs/guide/network.md)"};
  }
  return {
      "clock", Verdict::kWarning,
      fmt::format("not synchronised, although {} runs: it has found no reference (yet)", program),
      program == "chrony" ? "chronyc sources, chronyc tracking"
                          : "timedatectl timesync-status, or use chrony"};
}

Finding check_groups(const std::vector<std::string>& groups, const std::string& control_group,
                     bool is_root) {
  std::vector<std::string> missing;
  for (const std::string& group : {std::string("video"), control_group}) {
    if (!group.empty() && std::find(groups.begin(), groups.end(), group) == groups.end()) {
      missing.push_back(group);
    }
  }
  if (is_root || missing.empty()) {
    return {"permissions", Verdict::kOk, "you may use cameras and the control socket", ""};
  }
  return {"permissions", Verdict::kWarning,
          fmt::format("you are not a member of {}", fmt::join(missing, " and ")),
          fmt::format("sudo usermod -aG {} $USER, then log in again", fmt::join(missing, ","))};
}

Finding check_disk(const DiskSpace& space) {
  constexpr std::int64_t kFew = 100'000'000, kTooFew = 5'000'000;
  const std::string text = fmt::format("{:.1f} GB are free in {}",
                                       static_cast<double>(space.free_bytes) / 1e9, space.folder);
  if (space.free_bytes >= kFew) return {"disk", Verdict::kOk, text, ""};
  return {"disk", space.free_bytes < kTooFew ? Verdict::kProblem : Verdict::kWarning,
          fmt::format("only {:.0f} MB are free in {}",
                      std::floor(static_cast<double>(space.free_bytes) / 1e6), space.folder),
          "make room: journalctl --vacuum-size=100M, old recordings"};
}

Finding check_temperature(const MachineRoot& root) {
  constexpr double kHot = 80;  // a Raspberry Pi slows down from here on
  double hottest = -1;
  std::error_code error;
  for (fs::directory_iterator zone(root.of("/sys/class/thermal"), error), end;
       !error && zone != end; zone.increment(error)) {
    const std::string text = MachineRoot{zone->path().string()}.read("/temp");
    if (!text.empty()) hottest = std::max(hottest, std::strtod(text.c_str(), nullptr) / 1000);
  }
  if (hottest < 0) return {"temperature", Verdict::kOk, "this machine does not tell it", ""};
  if (hottest < kHot) {
    return {"temperature", Verdict::kOk, fmt::format("{:.0f} degrees", hottest), ""};
  }
  return {"temperature", Verdict::kWarning,
          fmt::format("{:.0f} degrees: the processor slows down, or soon will", hottest),
          "give it a fan or a larger heat sink"};
}

std::vector<Finding> check_throttling(const MachineRoot& root) {
  const std::string text = root.read("/sys/devices/platform/soc/soc:firmware/get_throttled");
  if (text.empty()) return {};
  const unsigned long state = std::strtoul(text.c_str(), nullptr, 16);
  const char* const remedy =
      "for voltage, a power supply of 5.1 V that is strong enough, and a short cable; for "
      "temperature, a fan";
  if (const std::string now = throttle_text(state, 0); !now.empty()) {
    return {{"throttling", Verdict::kProblem, "the Raspberry Pi has " + now, remedy}};
  }
  if (const std::string past = throttle_text(state, kSinceStart); !past.empty()) {
    return {{"throttling", Verdict::kWarning, "since it started, the Raspberry Pi has had " + past,
             remedy}};
  }
  return {{"throttling", Verdict::kOk, "the Raspberry Pi runs at full speed", ""}};
}

}  // namespace roundel
