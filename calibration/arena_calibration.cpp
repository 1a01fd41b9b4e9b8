#include "calibration/arena_calibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace roundel {
namespace {

// Files hold numbers exactly; what differs was calibrated anew.
bool same_lens(const CameraModel& a, const CameraModel& b) {
  const auto values = [](const CameraModel& c) {
    const Distortion& d = c.distortion;
    return std::array<double, 9>{c.fx, c.fy, c.cx, c.cy, d.k1, d.k2, d.p1, d.p2, d.k3};
  };
  const auto first = values(a), second = values(b);
  return std::equal(first.begin(), first.end(), second.begin(), [](double p, double q) {
    constexpr double kRounding = 1e-9;
    return std::abs(p - q) <= kRounding * std::max(1.0, std::abs(p));
  });
}

}  // namespace

std::string mismatch(const ArenaCamera& calibrated, const ArenaCamera& now) {
  const bool known = !now.identity.empty();
  if (known && calibrated.identity != now.identity) {
    return fmt::format("it belongs to the camera \"{}\", this is \"{}\"", calibrated.identity,
                       now.identity);
  }
  const CameraModel &then = calibrated.intrinsics, &here = now.intrinsics;
  if (then.width != here.width || then.height != here.height) {
    return fmt::format("it was made at {}x{} pixels, this is {}x{}", then.width, then.height,
                       here.width, here.height);
  }
  if (known && calibrated.crop != now.crop) {
    const auto named = [](const std::string& crop) { return crop.empty() ? "all" : crop; };
    return fmt::format("it was made with another part of the sensor ({}, now {})",
                       named(calibrated.crop), named(now.crop));
  }
  if (!same_lens(then, here)) return "the camera has been calibrated anew since it was made";
  return {};
}

}  // namespace roundel
