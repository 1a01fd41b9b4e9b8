#include "tools/frame_text.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <numbers>

namespace roundel {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;

// How far the marker's face is turned away from the ray to it.
double tilt(const Pose& pose) {
  return std::acos(std::min(1.0, -pose.normal().dot(pose.position.normalized())));
}

}  // namespace

std::string frame_text(const FrameInfo& info, std::span<const Marker> markers,
                       std::span<const ArenaPose> arena) {
  if (markers.empty()) {
    return fmt::format("{} frame {}: no marker\n", info.source, info.frame);
  }
  std::string text;
  for (std::size_t i = 0; i < markers.size(); ++i) {
    const Marker& marker = markers[i];
    auto out = std::back_inserter(text);
    fmt::format_to(out, "{} frame {}: ", info.source, info.frame);
    if (marker.track > 0) {
      fmt::format_to(out, "track {} ", marker.track);
    }
    if (marker.id >= 0) {
      fmt::format_to(out, "id {:<3} p {:.4f}", marker.id, marker.id_probability);
    } else {
      fmt::format_to(out, "id ?            ");
    }
    fmt::format_to(out, "  at {:8.2f} {:8.2f} px, {:.1f} x {:.1f} px", marker.u, marker.v,
                   2 * marker.ellipse.a, 2 * marker.ellipse.b);
    if (marker.has_pose) {
      const Eigen::Vector3d& p = marker.pose.position;
      fmt::format_to(out, "  x {:+.4f} y {:+.4f} z {:.4f} m  tilt {:.1f} deg  ambiguity {:.2f}",
                     p.x(), p.y(), p.z(), kDegrees * tilt(marker.pose), marker.ambiguity);
    }
    if (!arena.empty() && arena[i].valid) {
      const ArenaPose& place = arena[i];
      fmt::format_to(out, "  arena {:.4f} {:.4f} {:.4f} m", place.position.x(), place.position.y(),
                     place.position.z());
      if (marker.id >= 0) {
        fmt::format_to(out, "  heading {:.1f} deg", kDegrees * place.heading);
      }
    }
    text += '\n';
  }
  return text;
}

}  // namespace roundel
