#include "tools/json_camera.hpp"

#include "daemon/control/controls_json.hpp"

namespace roundel {
namespace {

using Json = nlohmann::ordered_json;

Json format_json(const OfferedFormat& format) {
  const PixelFormat* const known = find_pixel_format(format.fourcc);
  Json json = {{"format", fourcc_name(format.fourcc)},
               {"description", format.description},
               {"supported", known != nullptr},
               {"in_place", known != nullptr && known->reading == Reading::kInPlace},
               {"sizes", Json::array()}};
  for (const OfferedSize& size : format.sizes) {
    json["sizes"].push_back(
        {{"width", size.width}, {"height", size.height}, {"frame_rates", size.frame_rates}});
  }
  return json;
}

}  // namespace

Json camera_json(const ListedCamera& camera) {
  const CameraInformation& information = camera.information;
  Json json = {{"card", information.card},     {"device", information.node},
               {"bus", information.bus},       {"serial", information.serial},
               {"driver", information.driver}, {"links", information.links},
               {"formats", Json::array()},     {"controls", Json::array()}};
  for (const OfferedFormat& format : camera.formats) json["formats"].push_back(format_json(format));
  for (const Control& control : camera.controls) json["controls"].push_back(control_json(control));
  if (!information.problem.empty()) json["problem"] = information.problem;
  return json;
}

}  // namespace roundel
