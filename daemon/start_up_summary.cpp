#include "daemon/start_up_summary.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <string_view>

#include "transport/lcm_url.hpp"

namespace roundel {
namespace {

constexpr double kUsPerSecond = 1e6;

std::string_view words(StampSource source) {
  switch (source) {
    case StampSource::kMiddleOfExposure:
      return "the middle of their exposure";
    case StampSource::kStartOfFrame:
      return "their start, by the driver";
    case StampSource::kEndOfFrame:
      return "their end, by the driver";
    case StampSource::kArrival:
      return "their arrival here";
    default:
      return "an unknown instant";
  }
}

std::string_view words(ClockState state) {
  switch (state) {
    case ClockState::kSynchronised:
      return "synchronised";
    case ClockState::kFreeRunning:
      return "not synchronised";
    default:
      return "in an unknown state";
  }
}

std::string controls_line(const StartUpFacts& facts) {
  std::vector<std::string> texts;
  for (const auto& [name, value] : facts.values.camera.controls) {
    texts.push_back(fmt::format("{}={}", name, value));
  }
  return texts.empty() ? "controls: as the camera has them"
                       : fmt::format("controls: {}", fmt::join(texts, ", "));
}

std::string lens_line(const StartUpFacts& facts, double now_s) {
  const std::string& path = facts.values.camera.calibration;
  if (facts.information.calibration == CalibrationState::kNone) {
    return "lens: not calibrated: pixels, but no poses";
  }
  const std::string file = path.empty() ? "the simulator's own" : path;
  const std::string how_old =
      facts.lens_written_s > 0 ? ", " + age(facts.lens_written_s, now_s) : std::string();
  const bool fits = facts.information.calibration == CalibrationState::kValid;
  return fmt::format("lens: {}{}{}", file, how_old,
                     fits ? "" : ", of another resolution: pixels, but no poses");
}

// Seconds since the epoch of "2026-05-01T12:00:00Z"; 0 for anything else.
double seconds_of(const std::string& date) {
  std::tm fields{};
  const char* const end = ::strptime(date.c_str(), "%Y-%m-%dT%H:%M:%SZ", &fields);
  return end != nullptr && *end == '\0' ? static_cast<double>(::timegm(&fields)) : 0;
}

std::string arena_line(const StartUpFacts& facts, double now_s) {
  if (facts.arena == nullptr) return "arena: not calibrated";
  const double made_s = seconds_of(facts.arena->date);
  const std::string how_old =
      made_s > 0 ? fmt::format("{}, {}", facts.arena->date, age(made_s, now_s)) : "unknown date";
  return fmt::format("arena: {}: {} x {} m, certain to {:.2f} mm, {}{}", facts.values.arena.file,
                     facts.arena->request.width_m, facts.arena->request.height_m,
                     1000 * facts.arena->certainty_m, how_old,
                     facts.information.arena == ArenaState::kOtherCamera ? "; not used" : "");
}

std::string network_line(const StartUpFacts& facts) {
  const LcmSettings& lcm = facts.values.lcm;
  const LcmUrl url = parse_lcm_url(lcm.url);
  std::string line = fmt::format("poses: {}_FRAME on {}", lcm.channel, lcm.url);
  if (url.provider != LcmUrl::Provider::kUdp) return line;
  if (!lcm.copies.empty()) line += fmt::format(", and copies to {}", fmt::join(lcm.copies, ", "));
  if (url.is_multicast()) {
    line += fmt::format(", TTL {}", url.ttl);
    if (!lcm.interface_name.empty())
      return line + fmt::format(", by interface {}", lcm.interface_name);
  }
  if (facts.route.error != 0) return line + ", without a route yet";
  line += fmt::format(", by interface {}", facts.route.interface);
  return facts.route.address.empty() ? line : line + fmt::format(" ({})", facts.route.address);
}

}  // namespace

std::string age(double from_s, double now_s) {
  constexpr double kMinute = 60, kHour = 3600, kDay = 86400;
  const double seconds = now_s - from_s;
  const auto told = [&](double unit, std::string_view name) {
    const double count = std::floor(seconds / unit);
    return fmt::format("{:.0f} {}{} old", count, name, count == 1 ? "" : "s");
  };
  if (seconds < 0) return "from the future (is the clock right?)";
  if (seconds < kHour) return told(kMinute, "minute");
  return seconds < 2 * kDay ? told(kHour, "hour") : told(kDay, "day");
}

std::vector<std::string> start_up_summary(const StartUpFacts& facts) {
  const double now_s = static_cast<double>(facts.information.captured.wall_us) / kUsPerSecond;
  const DetectorParameters& markers = facts.values.detector;
  std::vector<std::string> lines = {
      fmt::format("frames: {}", facts.source),
      fmt::format("clock: frames are stamped at {}; wall clock {}",
                  words(facts.information.stamp_source), words(facts.information.clock)),
      fmt::format(
          "markers: {} m, {}", markers.diameter_m,
          markers.bits == 0 ? std::string("without a code") : fmt::format("{} bits", markers.bits)),
      lens_line(facts, now_s),
      arena_line(facts, now_s),
      network_line(facts)};
  if (facts.values.source == SourceKind::kCamera) {
    lines.insert(lines.begin() + 1, controls_line(facts));
  }
  return lines;
}

}  // namespace roundel
