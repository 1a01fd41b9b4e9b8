#include <fmt/format.h>

#include <memory>

#include "daemon/json_fields.hpp"
#include "daemon/json_frame.hpp"
#include "tools/commands.hpp"
#include "tools/control_client.hpp"
#include "tools/standard_output.hpp"

namespace roundel {
namespace {

using Json = nlohmann::ordered_json;

struct StatusOptions {
  std::string socket = kDefaultControlSocket;
  bool json = false;
};

std::string text_of(const Json& object, const char* key) {
  return has_field(object, key) ? string_field(object, key) : "";
}

std::string duration_text(double seconds) {
  const auto s = static_cast<std::int64_t>(seconds);
  if (s < 120) return fmt::format("{} s", s);
  if (s < 7200) return fmt::format("{} min", s / 60);
  if (s < 172800) return fmt::format("{} h", s / 3600);
  return fmt::format("{} days", s / 86400);
}

std::string arena_text(const Json& arena) {
  const std::string state = text_of(arena, "state");
  std::string text = state == "none"           ? "not calibrated"
                     : state == "valid"        ? "calibrated"
                     : state == "moved"        ? "CAMERA MOVED"
                     : state == "other_camera" ? "calibration not used"
                                               : state;
  if (const std::string date = text_of(arena, "date"); !date.empty()) text += " on " + date;
  if (state == "valid" || state == "moved") text += ", " + text_of(arena, "mode");
  if (const std::string problem = text_of(arena, "problem"); !problem.empty()) {
    text += ": " + problem;
  }
  if (const std::string watch = text_of(arena, "watch"); !watch.empty()) {
    text += "\n             " + watch;
  }
  return text;
}

std::string status_text(const Json& json) {
  const Json& camera = field(json, "camera");
  const Json& latency = field(field(json, "latency_us"), "total");
  const Json& tracking = field(field(json, "latency_us"), "tracking");
  std::string text = fmt::format("roundeld {}, running for {}\n", text_of(json, "version"),
                                 duration_text(number_field(json, "uptime_s")));
  text += fmt::format("camera       {}: {}\n", text_of(camera, "name"), text_of(camera, "source"));
  text += fmt::format("             {}, {}x{}, intrinsics: {}\n", text_of(camera, "state"),
                      number_field(camera, "width"), number_field(camera, "height"),
                      text_of(camera, "calibration"));
  text += fmt::format(
      "frames       {:.1f} a second, {} markers in the last; {} so far, {} dropped, {} "
      "not sent\n",
      number_field(json, "frame_rate"), number_field(json, "markers"), number_field(json, "frames"),
      number_field(json, "dropped"), number_field(json, "unsent"));
  text += fmt::format(
      "latency      {:.1f} ms from capture to network (99 %: {:.1f} ms), {:.1f} ms of "
      "it tracking\n",
      number_field(latency, "p50") / 1000, number_field(latency, "p99") / 1000,
      number_field(tracking, "p50") / 1000);
  text += fmt::format("arena        {}\n", arena_text(field(json, "arena")));
  text += fmt::format("clock        {}\n", text_of(json, "clock"));
  text += fmt::format("poses to     {}\n", text_of(field(json, "lcm"), "url"));
  return text;
}

}  // namespace

void add_status(CLI::App& app) {
  auto* command = app.add_subcommand("status", "How a running roundeld is doing");
  const auto options = std::make_shared<StatusOptions>();
  add_socket_option(*command, options->socket);
  command->add_flag("--json", options->json, "As one JSON object");
  command->callback([options] {
    const Json json = ControlClient(options->socket).get("/v1/status");
    print(options->json ? json_line(json) : status_text(json));
  });
}

}  // namespace roundel
