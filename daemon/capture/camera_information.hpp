#pragma once

#include <string>
#include <vector>

namespace roundel {

// A camera that is plugged in. Texts come from its driver; control characters are taken out.
struct CameraInformation {
  std::string node;                // /dev/video0
  std::vector<std::string> links;  // /dev/v4l/by-id/..., /dev/v4l/by-path/...
  std::string card;                // its name
  std::string bus;                 // where it is plugged in, as in usb-0000:00:14.0-1
  std::string serial;              // USB cameras; empty: unknown
  std::string driver;
  bool multiplanar = false;
  std::string problem;  // why it can't be opened; then node, links, card and serial are all that is
                        // known, and that it can capture is not
};

// Which camera to take. Without any rule it is the first.
struct CameraChoice {
  std::string device = {};  // node or link; empty: by the rules below
  std::string card = {};    // part of the name; each of these may be empty
  std::string bus = {};
  std::string serial = {};

  bool operator==(const CameraChoice&) const = default;
};

// "Name (/dev/video0, usb-0000:00:14.0-1, serial 1234)"
std::string describe(const CameraInformation& camera);

// Throws CameraAbsent if there is none, CameraError if rules leave more than one or it can't be
// opened.
CameraInformation choose_camera(const std::vector<CameraInformation>& cameras,
                                const CameraChoice& choice);

// The camera that was used before, wherever it is plugged in if it has a serial number, otherwise
// in the same place. Throws CameraAbsent if no camera is there, CameraError if others are.
CameraInformation find_again(const std::vector<CameraInformation>& cameras,
                             const CameraInformation& before);

}  // namespace roundel
