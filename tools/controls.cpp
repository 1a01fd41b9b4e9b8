#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

#include "daemon/json_fields.hpp"
#include "daemon/json_frame.hpp"
#include "tools/commands.hpp"
#include "tools/control_client.hpp"
#include "tools/standard_output.hpp"

namespace roundel {
namespace {

using Json = nlohmann::ordered_json;

struct ControlsOptions {
  std::string socket = kDefaultControlSocket;
  std::vector<std::string> assignments;
  bool json = false;
};

std::string controls_text(const Json& controls) {
  if (controls.empty()) return "the source of frames has no controls\n";
  std::string text;
  for (const Json& control : controls) {
    const bool menu = has_field(control, "menu");
    std::string accepted =
        fmt::format("{} to {}", field(control, "minimum").dump(), field(control, "maximum").dump());
    std::string value = field(control, "value").dump();
    if (menu) {
      accepted.clear();
      for (const Json& item : array_field(control, "menu")) {
        accepted += (accepted.empty() ? "" : ", ") + string_field(item, "name");
        if (field(item, "value") == field(control, "value")) value = string_field(item, "name");
      }
    }
    text += fmt::format("{:<34} {:<18} {}\n", string_field(control, "name"), value, accepted);
  }
  return text;
}

Json values_json(const std::vector<std::string>& assignments) {
  Json values = Json::object();
  for (const std::string& text : assignments) {
    const std::size_t equals = text.find('=');
    if (equals == 0 || equals == std::string::npos) {
      throw UsageError(fmt::format("{}: must read NAME=VALUE, as in gain=20", text));
    }
    values[text.substr(0, equals)] = text.substr(equals + 1);
  }
  return values;
}

void run_controls(const ControlsOptions& options) {
  const ControlClient client(options.socket);
  const Json answer = options.assignments.empty()
                          ? client.get("/v1/controls")
                          : client.send("PUT", "/v1/controls", values_json(options.assignments));
  print(options.json ? json_line(answer) : controls_text(array_field(answer, "controls")));
}

}  // namespace

void add_controls(CLI::App& app) {
  auto* command =
      app.add_subcommand("controls",
                         "Show or set the controls of the camera in use. What is set here lasts "
                         "until roundeld ends or "
                         "camera.controls in its configuration is changed, which lasts longer");
  const auto options = std::make_shared<ControlsOptions>();
  add_socket_option(*command, options->socket);
  command->add_option("NAME=VALUE", options->assignments, "What to set; nothing: show all");
  command->add_flag("--json", options->json, "As one JSON object");
  command->callback([options] { run_controls(*options); });
}

}  // namespace roundel
