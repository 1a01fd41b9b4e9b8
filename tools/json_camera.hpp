#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "daemon/capture/camera_information.hpp"
#include "daemon/capture/camera_mode.hpp"
#include "daemon/capture/device_controls.hpp"

namespace roundel {

// What `roundel cameras` tells about one.
struct ListedCamera {
  CameraInformation information;
  std::vector<OfferedFormat> formats;
  std::vector<Control> controls;
  std::string problem;  // why the two above are empty
};

nlohmann::ordered_json camera_json(const ListedCamera& camera);

}  // namespace roundel
