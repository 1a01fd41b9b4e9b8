#include "tools/json_truth.hpp"

#include <cmath>

#include "tools/json_frame.hpp"

namespace roundel {
namespace {

const char* name_of(MarkerKind kind) {
  switch (kind) {
    case MarkerKind::WhyCode:
      return "whycode";
    case MarkerKind::WhyCon:
      return "whycon";
    case MarkerKind::Disc:
      return "disc";
  }
  return "";
}

}  // namespace

nlohmann::ordered_json truth_json(const FrameTruth& truth) {
  auto markers = nlohmann::ordered_json::array();
  for (const MarkerTruth& marker : truth.markers) {
    markers.push_back(
        {{"id", marker.id},
         {"kind", name_of(marker.kind)},
         {"visible", marker.visible},
         {"u", marker.u},
         {"v", marker.v},
         {"position", vector_json(marker.pose.position)},
         {"orientation", quaternion_json(marker.pose.orientation)},
         {"arena",
          {{"x", marker.x}, {"y", marker.y}, {"z", marker.z}, {"heading", marker.heading}}}});
  }
  return {{"frame", truth.frame},
          {"utime", std::llround(truth.time_s * 1e6)},
          {"markers", std::move(markers)}};
}

}  // namespace roundel
