#pragma once

#include <vector>

#include "config/reader.hpp"
#include "daemon/capture/video_device.hpp"
#include "tools/doctor/finding.hpp"

namespace roundel {

// Whether the configured camera is there, in what mode it would run, whether its bus can carry
// that, and which of its automatics are on. Looking does not disturb a roundeld that uses it.
std::vector<Finding> check_camera(const MachineRoot& root, const CameraSystem& system,
                                  const LoadedConfiguration& configuration);

}  // namespace roundel
