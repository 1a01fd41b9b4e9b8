#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/capture/video_device.hpp"

namespace roundel {

// A control of a camera, as `v4l2-ctl -l` shows it.
struct Control {
  enum class Type : std::uint8_t { kInteger, kBoolean, kMenu, kButton, kOther };
  struct MenuItem {
    std::int64_t index = 0;
    std::string name;
  };

  std::uint32_t id = 0;
  std::string name;   // exposure_time_absolute
  std::string label;  // Exposure Time, Absolute
  Type type = Type::kOther;
  std::int64_t minimum = 0, maximum = 0, step = 1, default_value = 0;
  std::int64_t value = 0;  // kInteger, kBoolean, kMenu
  std::vector<MenuItem> menu;
  bool wide = false;  // its value has 64 bits
  bool read_only = false;
  bool inactive = false;   // without effect as long as an automatic is on
  bool automatic = false;  // switches an automatic that owns other controls
};

std::string_view name_of(Control::Type type);
// Its value in words: 120, true, "Manual Mode".
std::string value_text(const Control& control);

// Values that are wanted, by the names of controls: numbers, true and false, items of a menu by
// name or number.
using ControlValues = std::map<std::string, std::string>;

// All that are not disabled, with their values.
std::vector<Control> list_controls(VideoDevice& device);

// The control's value that a text means. Throws std::invalid_argument, naming what is accepted.
std::int64_t parse_control_value(const Control& control, const std::string& text);

// The control of a name. Throws std::invalid_argument, listing those that there are.
const Control& find_control(const std::vector<Control>& controls, const std::string& name);

// 0, or errno.
int set_control(VideoDevice& device, const Control& control, std::int64_t value);
// What that errno means to its user.
std::string refusal_of_control(int error);

// Sets controls, automatics first, and reads them back. What is not as wanted, a sentence for each.
std::vector<std::string> apply_controls(VideoDevice& device, const ControlValues& wanted);

}  // namespace roundel
