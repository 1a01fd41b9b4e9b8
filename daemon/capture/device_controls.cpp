#include "daemon/capture/device_controls.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <linux/videodev2.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <stdexcept>

#include "daemon/capture/driver_text.hpp"

namespace roundel {
namespace {

constexpr std::size_t kMost = 1000;  // controls; a driver that never ends is not followed
constexpr std::int64_t kMostMenuItems = 256;

// As v4l2-ctl makes names: letters and digits, everything between them one underscore.
std::string name_from(const std::string& label) {
  std::string name;
  bool gap = false;
  for (const char c : label) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) {
      gap = !name.empty();
      continue;
    }
    if (gap) name += '_';
    gap = false;
    name += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return name;
}

Control::Type type_of(const v4l2_query_ext_ctrl& query) {
  // Arrays and structures have no single value.
  if ((query.flags & V4L2_CTRL_FLAG_HAS_PAYLOAD) != 0) return Control::Type::kOther;
  switch (query.type) {
    case V4L2_CTRL_TYPE_INTEGER:
    case V4L2_CTRL_TYPE_INTEGER64:
    case V4L2_CTRL_TYPE_BITMASK:
      return Control::Type::kInteger;
    case V4L2_CTRL_TYPE_BOOLEAN:
      return Control::Type::kBoolean;
    case V4L2_CTRL_TYPE_MENU:
    case V4L2_CTRL_TYPE_INTEGER_MENU:
      return Control::Type::kMenu;
    case V4L2_CTRL_TYPE_BUTTON:
      return Control::Type::kButton;
    default:
      return Control::Type::kOther;
  }
}

// What decides over others has to be set before them.
bool is_automatic(std::uint32_t id, std::uint32_t flags) {
  constexpr std::array<std::uint32_t, 10> kAutomatics = {V4L2_CID_EXPOSURE_AUTO,
                                                         V4L2_CID_EXPOSURE_AUTO_PRIORITY,
                                                         V4L2_CID_AUTOGAIN,
                                                         V4L2_CID_AUTO_WHITE_BALANCE,
                                                         V4L2_CID_AUTO_N_PRESET_WHITE_BALANCE,
                                                         V4L2_CID_HUE_AUTO,
                                                         V4L2_CID_AUTOBRIGHTNESS,
                                                         V4L2_CID_FOCUS_AUTO,
                                                         V4L2_CID_ISO_SENSITIVITY_AUTO,
                                                         V4L2_CID_3A_LOCK};
  return (flags & V4L2_CTRL_FLAG_UPDATE) != 0 ||
         std::find(kAutomatics.begin(), kAutomatics.end(), id) != kAutomatics.end();
}

bool has_value(const Control& control) {
  return control.type == Control::Type::kInteger || control.type == Control::Type::kBoolean ||
         control.type == Control::Type::kMenu;
}

std::vector<Control::MenuItem> menu_of(VideoDevice& device, const v4l2_query_ext_ctrl& query) {
  std::vector<Control::MenuItem> items;
  const std::int64_t first = std::clamp<std::int64_t>(query.minimum, 0, UINT32_MAX);
  const std::int64_t last = std::min<std::int64_t>(query.maximum, first + kMostMenuItems);
  for (std::int64_t index = first; index <= last; ++index) {
    v4l2_querymenu item{};
    item.id = query.id;
    item.index = static_cast<std::uint32_t>(index);
    if (device.control(VIDIOC_QUERYMENU, &item) != 0) continue;  // menus may have holes
    items.push_back({index, query.type == V4L2_CTRL_TYPE_INTEGER_MENU
                                ? fmt::format("{}", static_cast<std::int64_t>(item.value))
                                : driver_text(item.name)});
  }
  return items;
}

v4l2_ext_controls request_for(v4l2_ext_control& control) {
  v4l2_ext_controls request{};
  request.which = V4L2_CTRL_WHICH_CUR_VAL;
  request.count = 1;
  request.controls = &control;
  return request;
}

void read_value(VideoDevice& device, Control& control) {
  v4l2_ext_control value{};
  value.id = control.id;
  v4l2_ext_controls request = request_for(value);
  if (device.control(VIDIOC_G_EXT_CTRLS, &request) != 0) return;
  control.value = control.wide ? value.value64 : value.value;
}

std::string accepted_values(const Control& control) {
  switch (control.type) {
    case Control::Type::kBoolean:
      return "true, false";
    case Control::Type::kMenu: {
      std::vector<std::string> items;
      items.reserve(control.menu.size());
      for (const Control::MenuItem& item : control.menu) {
        items.push_back(fmt::format("{} ({})", item.name, item.index));
      }
      return fmt::format("{}", fmt::join(items, ", "));
    }
    case Control::Type::kInteger:
      return fmt::format("a whole number from {} to {}", control.minimum, control.maximum) +
             (control.step > 1 ? fmt::format(" in steps of {}", control.step) : "");
    default:
      return "nothing: it can't be set to a value";
  }
}

bool same_word(const std::string& a, const std::string& b) {
  return name_from(a) == name_from(b);
}

}  // namespace

std::string_view name_of(Control::Type type) {
  switch (type) {
    case Control::Type::kInteger:
      return "integer";
    case Control::Type::kBoolean:
      return "boolean";
    case Control::Type::kMenu:
      return "menu";
    case Control::Type::kButton:
      return "button";
    default:
      return "other";
  }
}

std::string value_text(const Control& control) {
  if (control.type == Control::Type::kBoolean) return control.value != 0 ? "true" : "false";
  for (const Control::MenuItem& item : control.menu) {
    if (item.index == control.value) return item.name;
  }
  return fmt::format("{}", control.value);
}

std::vector<Control> list_controls(VideoDevice& device) {
  std::vector<Control> controls;
  v4l2_query_ext_ctrl query{};
  query.id = V4L2_CTRL_FLAG_NEXT_CTRL;
  while (controls.size() < kMost && device.control(VIDIOC_QUERY_EXT_CTRL, &query) == 0) {
    if ((query.flags & V4L2_CTRL_FLAG_DISABLED) == 0 && query.type != V4L2_CTRL_TYPE_CTRL_CLASS) {
      Control control;
      control.id = query.id;
      control.label = driver_text(query.name);
      control.name = name_from(control.label);
      control.type = type_of(query);
      control.wide = query.type == V4L2_CTRL_TYPE_INTEGER64;
      control.minimum = query.minimum;
      control.maximum = query.maximum;
      control.step = static_cast<std::int64_t>(query.step);
      control.default_value = query.default_value;
      control.read_only = (query.flags & V4L2_CTRL_FLAG_READ_ONLY) != 0;
      control.inactive = (query.flags & (V4L2_CTRL_FLAG_INACTIVE | V4L2_CTRL_FLAG_GRABBED)) != 0;
      control.automatic = is_automatic(query.id, query.flags);
      if (control.type == Control::Type::kMenu) control.menu = menu_of(device, query);
      if (has_value(control) && (query.flags & V4L2_CTRL_FLAG_WRITE_ONLY) == 0) {
        read_value(device, control);
      }
      controls.push_back(std::move(control));
    }
    const std::uint32_t last = query.id;
    query = {};
    query.id = last | V4L2_CTRL_FLAG_NEXT_CTRL;
  }
  return controls;
}

std::int64_t parse_control_value(const Control& control, const std::string& text) {
  std::int64_t value = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  const bool number = error == std::errc() && stop == end;
  switch (control.type) {
    case Control::Type::kBoolean:
      if (text == "true" || (number && value == 1)) return 1;
      if (text == "false" || (number && value == 0)) return 0;
      break;
    case Control::Type::kMenu:
      for (const Control::MenuItem& item : control.menu) {
        if (same_word(item.name, text)) return item.index;
      }
      for (const Control::MenuItem& item : control.menu) {
        if (number && item.index == value) return value;
      }
      break;
    case Control::Type::kInteger:
      if (number && value >= control.minimum && value <= control.maximum) return value;
      break;
    case Control::Type::kButton:
      if (text == "true" || (number && value == 1)) return 1;
      break;
    case Control::Type::kOther:
      break;
  }
  throw std::invalid_argument(fmt::format("{}: \"{}\" can't be set; accepted: {}", control.name,
                                          text, accepted_values(control)));
}

const Control& find_control(const std::vector<Control>& controls, const std::string& name) {
  std::vector<std::string> names;
  for (const Control& control : controls) {
    if (control.name == name) return control;
    names.push_back(control.name);
  }
  throw std::invalid_argument(
      fmt::format("{}: the camera has no such control; it has: {}", name,
                  names.empty() ? std::string("none") : fmt::format("{}", fmt::join(names, ", "))));
}

int set_control(VideoDevice& device, const Control& control, std::int64_t wanted) {
  v4l2_ext_control value{};
  value.id = control.id;
  if (control.wide) {
    value.value64 = wanted;
  } else {
    value.value = static_cast<std::int32_t>(wanted);
  }
  v4l2_ext_controls request = request_for(value);
  return device.control(VIDIOC_S_EXT_CTRLS, &request);
}

std::string refusal_of_control(int error) {
  switch (error) {
    case EACCES:
      return "the camera does not allow it now (read-only, or an automatic owns it)";
    case EBUSY:
      return "the camera does not allow it while it streams";
    case ERANGE:
    case EINVAL:
      return "the camera does not take this value";
    default:
      return reason_of(error);
  }
}

std::vector<std::string> apply_controls(VideoDevice& device, const ControlValues& wanted) {
  std::vector<std::string> remarks;
  if (wanted.empty()) return remarks;
  struct Setting {
    Control control;
    std::int64_t value;
  };
  std::vector<Setting> settings;
  const std::vector<Control> before = list_controls(device);
  for (const auto& [name, text] : wanted) {
    try {
      const Control& control = find_control(before, name);
      settings.push_back({control, parse_control_value(control, text)});
    } catch (const std::invalid_argument& error) {
      remarks.emplace_back(error.what());
    }
  }
  std::stable_partition(settings.begin(), settings.end(),
                        [](const Setting& setting) { return setting.control.automatic; });
  std::vector<std::string> failed;
  for (const Setting& setting : settings) {
    const int error = set_control(device, setting.control, setting.value);
    if (error == 0) continue;
    remarks.push_back(
        fmt::format("{}: can't be set: {}", setting.control.name, refusal_of_control(error)));
    failed.push_back(setting.control.name);
  }
  // Read back when all are set: one may have changed another.
  const std::vector<Control> after = list_controls(device);
  for (const Setting& setting : settings) {
    if (std::find(failed.begin(), failed.end(), setting.control.name) != failed.end()) continue;
    const auto now = std::find_if(after.begin(), after.end(), [&](const Control& control) {
      return control.id == setting.control.id;
    });
    if (now == after.end() || !has_value(*now)) continue;
    if (now->value != setting.value) {
      remarks.push_back(
          fmt::format("{}: set to {}, but it is {}", now->name, setting.value, value_text(*now)));
    } else if (now->inactive) {
      remarks.push_back(
          fmt::format("{}: has no effect as long as an automatic owns it (set that to manual, too)",
                      now->name));
    }
  }
  return remarks;
}

}  // namespace roundel
