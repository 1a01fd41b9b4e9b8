#include "daemon/control/controls_json.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace roundel {

using Json = nlohmann::ordered_json;

Json control_json(const Control& control) {
  Json json = {{"name", control.name},
               {"label", control.label},
               {"type", std::string(name_of(control.type))},
               {"value", control.value},
               {"default", control.default_value},
               {"minimum", control.minimum},
               {"maximum", control.maximum},
               {"step", control.step},
               {"read_only", control.read_only},
               {"inactive", control.inactive}};
  for (const Control::MenuItem& item : control.menu) {
    json["menu"].push_back({{"value", item.index}, {"name", item.name}});
  }
  return json;
}

ControlValues control_values_from_json(const Json& json) {
  constexpr std::size_t kMost = 200;
  if (!json.is_object() || json.empty() || json.size() > kMost) {
    throw std::runtime_error("the request must be a JSON object of control names and values");
  }
  ControlValues values;
  for (const auto& [name, value] : json.items()) {
    if (value.is_string()) {
      values[name] = value.get<std::string>();
    } else if (value.is_boolean() || value.is_number_integer()) {
      values[name] = value.dump();
    } else {
      throw std::runtime_error(fmt::format("{} is not a whole number, true, false or text", name));
    }
  }
  return values;
}

}  // namespace roundel
