#include "daemon/json_frame.hpp"

#include <fmt/format.h>

#include <limits>
#include <stdexcept>

#include "daemon/json_fields.hpp"

namespace roundel {

using Json = nlohmann::ordered_json;

namespace {

constexpr auto kLargest = std::numeric_limits<std::int64_t>::max();

Marker marker_from_json(const Json& json) {
  Marker marker;
  marker.id = static_cast<std::int32_t>(
      integer_field(json, "id", -1, std::numeric_limits<std::int32_t>::max()));
  marker.u = number_field(json, "u");
  marker.v = number_field(json, "v");
  if (has_field(json, "id_probability")) {
    marker.id_probability = number_field(json, "id_probability");
  }
  if (has_field(json, "track")) {
    marker.track = integer_field(json, "track", 0, kLargest);
  }
  marker.has_pose = has_field(json, "position") || has_field(json, "orientation");
  if (marker.has_pose) {
    marker.pose = {vector_field(json, "position"), quaternion_field(json, "orientation")};
  }
  if (has_field(json, "sigma")) {
    const Json& sigma = field(json, "sigma");
    marker.sigma_position = vector_field(sigma, "position");
    marker.sigma_rotation = vector_field(sigma, "rotation");
  }
  return marker;
}

}  // namespace

Json vector_json(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

Json quaternion_json(const Eigen::Quaterniond& q) {
  return {q.w(), q.x(), q.y(), q.z()};
}

Json marker_json(const Marker& marker, const ArenaPose& arena) {
  Json json = {
      {"id", marker.id},
      {"id_probability", marker.id_probability},
      {"track", marker.track},
      {"u", marker.u},
      {"v", marker.v},
      {"ellipse",
       {{"a", marker.ellipse.a}, {"b", marker.ellipse.b}, {"angle", marker.ellipse.angle}}},
  };
  if (!marker.has_pose) {
    return json;
  }
  json["position"] = vector_json(marker.pose.position);
  json["orientation"] = quaternion_json(marker.pose.orientation);
  json["sigma"] = {{"position", vector_json(marker.sigma_position)},
                   {"rotation", vector_json(marker.sigma_rotation)}};
  json["ambiguity"] = marker.ambiguity;
  if (marker.has_alternative) {
    json["alternative"] = {{"position", vector_json(marker.alternative.position)},
                           {"orientation", quaternion_json(marker.alternative.orientation)}};
  }
  if (arena.valid) {
    const Eigen::Vector3d& p = arena.position;
    json["arena"] = {
        {"x", p.x()},
        {"y", p.y()},
        {"z", p.z()},
        {"heading", arena.heading},
        {"sigma",
         {{"position", vector_json(arena.sigma_position)}, {"heading", arena.sigma_heading}}}};
  }
  return json;
}

Json frame_json(const FrameInfo& info, std::span<const Marker> markers,
                std::span<const ArenaPose> arena) {
  Json list = Json::array();
  for (std::size_t i = 0; i < markers.size(); ++i) {
    list.push_back(marker_json(markers[i], arena.empty() ? ArenaPose() : arena[i]));
  }
  return {{"source", info.source},
          {"frame", info.frame},
          {"utime", info.utime},
          {"elapsed_us", info.elapsed_us},
          {"markers", std::move(list)}};
}

ReportedFrame frame_from_json(const Json& json) {
  ReportedFrame frame;
  frame.frame = integer_field(json, "frame", 0, kLargest);
  const Json& list = array_field(json, "markers");
  frame.markers.reserve(list.size());
  for (const Json& marker : list) {
    try {
      frame.markers.push_back(marker_from_json(marker));
    } catch (const std::runtime_error& error) {
      throw std::runtime_error(fmt::format("markers[{}]: {}", frame.markers.size(), error.what()));
    }
  }
  return frame;
}

std::string json_line(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace roundel
