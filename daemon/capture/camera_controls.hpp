#pragma once

#include <mutex>
#include <string>
#include <vector>

#include "daemon/capture/device_controls.hpp"

namespace roundel {

// The controls of the camera in use, for any thread. Every call opens the camera for itself, so
// that neither a slow camera nor a slow caller ever holds up the thread that carries frames.
class CameraControls {
 public:
  CameraControls(const CameraSystem& system, ControlValues wanted);

  // Both throw CameraError while there is no camera.
  std::vector<Control> list() const;
  // Sets a control now, and again whenever the camera comes back; returns it as it was read back.
  // Throws std::invalid_argument for a name or value that the camera does not have, CameraError if
  // the camera refuses it.
  Control set(const std::string& name, const std::string& value);

  // What is to be set: the configuration's, and what set() added or changed.
  ControlValues wanted() const;
  // Takes those of a new configuration and sets them. Remarks as of apply_controls(); nothing is
  // set without a camera.
  std::vector<std::string> replace(const ControlValues& wanted);

  // For the source of frames: which camera is in use; an empty node: none.
  void attach(const std::string& node);

 private:
  std::unique_ptr<VideoDevice> open() const;

  const CameraSystem& system_;
  mutable std::mutex mutex_;  // held for the time of a copy
  std::string node_;
  ControlValues wanted_;
};

}  // namespace roundel
