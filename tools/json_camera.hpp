#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "daemon/capture/camera_information.hpp"
#include "daemon/capture/camera_mode.hpp"
#include "daemon/capture/device_controls.hpp"

namespace roundel {

// What `roundel cameras` tells about one; no formats and controls where it has a problem.
struct ListedCamera {
  CameraInformation information;
  std::vector<OfferedFormat> formats;
  std::vector<Control> controls;
};

nlohmann::ordered_json camera_json(const ListedCamera& camera);

}  // namespace roundel
