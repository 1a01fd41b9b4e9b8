#include "tools/json_frame.hpp"

namespace roundel {

using Json = nlohmann::ordered_json;

Json vector_json(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

Json quaternion_json(const Eigen::Quaterniond& q) {
  return {q.w(), q.x(), q.y(), q.z()};
}

Json marker_json(const Marker& marker) {
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
  return json;
}

Json frame_json(const FrameInfo& info, std::span<const Marker> markers) {
  Json list = Json::array();
  for (const Marker& marker : markers) {
    list.push_back(marker_json(marker));
  }
  return {{"source", info.source},
          {"frame", info.frame},
          {"utime", info.utime},
          {"elapsed_us", info.elapsed_us},
          {"markers", std::move(list)}};
}

std::string json_line(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace roundel
