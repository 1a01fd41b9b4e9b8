#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "daemon/capture/camera_mode.hpp"
#include "daemon/capture/device_controls.hpp"
#include "daemon/json_frame.hpp"
#include "tools/commands.hpp"
#include "tools/json_camera.hpp"
#include "tools/standard_output.hpp"

namespace roundel {
namespace {

std::string rates_text(const OfferedSize& size) {
  std::vector<std::string> rates;
  rates.reserve(size.frame_rates.size());
  for (const double rate : size.frame_rates) rates.push_back(fmt::format("{:.4g}", rate));
  return rates.empty() ? "" : fmt::format(" at {}/s", fmt::join(rates, ", "));
}

std::string formats_text(const std::vector<OfferedFormat>& formats) {
  std::string text;
  for (const OfferedFormat& format : formats) {
    const PixelFormat* const known = find_pixel_format(format.fourcc);
    text += fmt::format("  {:<8} {} ({})\n", fourcc_name(format.fourcc), format.description,
                        known == nullptr ? "only by libv4l2's conversion" : how_it_is_read(*known));
    if (format.sizes.empty()) text += fmt::format("           any size that its driver accepts\n");
    for (const OfferedSize& size : format.sizes) {
      text += fmt::format("           {}x{}{}\n", size.width, size.height, rates_text(size));
    }
  }
  return text;
}

std::string range_text(const Control& control) {
  if (!control.menu.empty()) {
    std::vector<std::string> items;
    items.reserve(control.menu.size());
    for (const Control::MenuItem& item : control.menu) items.push_back(item.name);
    return fmt::format("{}", fmt::join(items, ", "));
  }
  if (control.type == Control::Type::kBoolean) return "true, false";
  if (control.type != Control::Type::kInteger) return std::string(name_of(control.type));
  return fmt::format("{} to {}{}", control.minimum, control.maximum,
                     control.step > 1 ? fmt::format(" in steps of {}", control.step) : "");
}

std::string controls_text(const std::vector<Control>& controls) {
  std::string text;
  for (const Control& control : controls) {
    text += fmt::format("  {:<30} {:<16} {}{}{}\n", control.name, value_text(control),
                        range_text(control), control.read_only ? ", read-only" : "",
                        control.inactive ? ", without effect now (an automatic owns it)" : "");
  }
  return text;
}

std::string camera_text(const ListedCamera& camera) {
  std::string text;
  text += fmt::format("{}\n", describe(camera.information));
  for (const std::string& link : camera.information.links) text += fmt::format("  {}\n", link);
  if (!camera.formats.empty()) {
    text += fmt::format("\n  formats, driver {}\n", camera.information.driver);
    text += formats_text(camera.formats);
  }
  if (!camera.controls.empty()) {
    text += fmt::format("\n  controls, their values, and what they accept\n");
    text += controls_text(camera.controls);
  }
  return text + "\n";
}

ListedCamera look_at(const CameraInformation& information) {
  ListedCamera camera{information, {}, {}};
  if (!information.problem.empty()) return camera;
  try {
    const std::unique_ptr<VideoDevice> device = kernel_cameras().open(information.node);
    camera.formats = offered_formats(*device, information.multiplanar);
    camera.controls = list_controls(*device);
  } catch (const CameraError& error) {  // unplugged in this moment
    camera.information.problem = error.what();
  }
  return camera;
}

void list_cameras(bool json) {
  const std::vector<CameraInformation> cameras = kernel_cameras().cameras();
  if (cameras.empty()) {
    throw std::runtime_error(
        "there is no camera that can capture (is it plugged in? On a Raspberry Pi, see "
        "docs/guide/camera.md for cameras at the CSI connector)");
  }
  if (std::none_of(cameras.begin(), cameras.end(),
                   [](const CameraInformation& camera) { return camera.problem.empty(); })) {
    throw std::runtime_error(cameras.front().problem);
  }
  for (const CameraInformation& information : cameras) {
    const ListedCamera camera = look_at(information);
    print(json ? json_line(camera_json(camera)) : camera_text(camera));
  }
}

}  // namespace

void add_cameras(CLI::App& app) {
  auto* command = app.add_subcommand(
      "cameras", "List the cameras of this machine: formats, sizes, frame rates, controls");
  const auto json = std::make_shared<bool>(false);
  command->add_flag("--json", *json, "One JSON object a camera");
  command->footer("Ends with status 1 if there is no camera.");
  command->callback([json] { list_cameras(*json); });
}

}  // namespace roundel
