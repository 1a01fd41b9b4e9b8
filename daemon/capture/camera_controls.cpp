#include "daemon/capture/camera_controls.hpp"

#include <fmt/format.h>

namespace roundel {

CameraControls::CameraControls(const CameraSystem& system, ControlValues wanted)
    : system_(system), wanted_(std::move(wanted)) {}

std::unique_ptr<VideoDevice> CameraControls::open() const {
  std::string node;
  {
    const std::lock_guard lock(mutex_);
    node = node_;
  }
  if (node.empty()) throw CameraError("the camera is not there");
  return system_.open(node);
}

std::vector<Control> CameraControls::list() const {
  return list_controls(*open());
}

Control CameraControls::set(const std::string& name, const std::string& value) {
  const std::unique_ptr<VideoDevice> device = open();
  const Control control = find_control(list_controls(*device), name);
  const int error = set_control(*device, control, parse_control_value(control, value));
  if (error != 0) {
    throw CameraError(fmt::format("{}: can't be set: {}", name, refusal_of_control(error)));
  }
  if (control.type != Control::Type::kButton) {
    const std::lock_guard lock(mutex_);
    wanted_[name] = value;
  }
  return find_control(list_controls(*device), name);
}

ControlValues CameraControls::wanted() const {
  const std::lock_guard lock(mutex_);
  return wanted_;
}

std::vector<std::string> CameraControls::replace(const ControlValues& wanted) {
  {
    const std::lock_guard lock(mutex_);
    wanted_ = wanted;
    if (node_.empty()) return {};
  }
  try {
    return apply_controls(*open(), wanted);
  } catch (const CameraError& error) {
    return {error.what()};
  }
}

void CameraControls::attach(const std::string& node) {
  const std::lock_guard lock(mutex_);
  node_ = node;
}

}  // namespace roundel
