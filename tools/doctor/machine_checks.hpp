#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/doctor/finding.hpp"
#include "transport/frame_information.hpp"

namespace roundel {

// The wall clock, which poses are stamped with: whether it follows a reference, and by what.
Finding check_clock(const MachineRoot& root, ClockState state);

// The user's groups, against those that may use the camera and the control socket.
Finding check_groups(const std::vector<std::string>& groups, const std::string& control_group,
                     bool is_root);

// Room for calibration and journal where the folder is.
struct DiskSpace {
  std::string folder;
  std::int64_t free_bytes = 0;
};
Finding check_disk(const DiskSpace& space);

// The hottest part of the machine.
Finding check_temperature(const MachineRoot& root);
// Whether a Raspberry Pi slows itself down; nothing elsewhere.
std::vector<Finding> check_throttling(const MachineRoot& root);

}  // namespace roundel
