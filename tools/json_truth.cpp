#include "tools/json_truth.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>

#include "daemon/json_fields.hpp"
#include "daemon/json_frame.hpp"

namespace roundel {
namespace {

using Json = nlohmann::ordered_json;

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

MarkerKind kind_of(const std::string& name) {
  for (const MarkerKind kind : {MarkerKind::WhyCode, MarkerKind::WhyCon, MarkerKind::Disc}) {
    if (name == name_of(kind)) {
      return kind;
    }
  }
  throw std::runtime_error("kind is not whycode, whycon or disc");
}

// A marker behind the camera has no image: null.
double pixel_field(const Json& json, const char* key) {
  return field(json, key).is_null() ? std::numeric_limits<double>::quiet_NaN()
                                    : number_field(json, key);
}

MarkerTruth marker_from_json(const Json& json) {
  MarkerTruth marker;
  marker.kind = kind_of(string_field(json, "kind"));
  if (marker.kind == MarkerKind::WhyCode) {
    marker.id =
        static_cast<int>(integer_field(json, "id", 1, std::numeric_limits<std::int32_t>::max()));
  }
  marker.visible = bool_field(json, "visible");
  marker.u = pixel_field(json, "u");
  marker.v = pixel_field(json, "v");
  if (marker.visible && (std::isnan(marker.u) || std::isnan(marker.v))) {
    throw std::runtime_error("is visible but has no image (u, v)");
  }
  marker.pose = {vector_field(json, "position"), quaternion_field(json, "orientation")};
  return marker;
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

FrameTruth truth_from_json(const Json& json) {
  constexpr auto kLargest = std::numeric_limits<std::int64_t>::max();
  FrameTruth truth;
  truth.frame = integer_field(json, "frame", 0, kLargest);
  truth.time_s = 1e-6 * static_cast<double>(integer_field(json, "utime", 0, kLargest));
  for (const Json& marker : array_field(json, "markers")) {
    try {
      truth.markers.push_back(marker_from_json(marker));
    } catch (const std::runtime_error& error) {
      throw std::runtime_error(fmt::format("markers[{}]: {}", truth.markers.size(), error.what()));
    }
  }
  return truth;
}

}  // namespace roundel
