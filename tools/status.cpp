#include <fmt/format.h>

#include <array>
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

std::string drops_text(const Json& drops) {
  return fmt::format(
      "{} lost before they reached roundeld, {} left out for a newer one, {} damaged, {} too old",
      number_field(drops, "lost"), number_field(drops, "newer"), number_field(drops, "damaged"),
      number_field(drops, "stale"));
}

// Stage by stage, of the frames of the last second.
std::string latency_text(const Json& latency) {
  struct Stage {
    const char* name;
    const char* meaning;
  };
  static constexpr std::array kStages = {Stage{"arrival", "from capture to roundeld"},
                                         Stage{"reading", "decoding, where it is needed"},
                                         Stage{"tracking", "to the markers"},
                                         Stage{"following", "of that: known markers"},
                                         Stage{"searching", "of that: lost ones, newcomers"},
                                         Stage{"identifying", "of that: what was found so"},
                                         Stage{"publishing", "to the last message"},
                                         Stage{"handling", "from roundeld to the last message"},
                                         Stage{"total", "from capture to the last message"}};
  if (number_field(field(latency, "total"), "max") == 0) {
    return "latency      no frame in the last second\n";
  }
  std::string text = fmt::format("latency, ms  {:<11} {:>7} {:>7} {:>7} {:>7}\n", "", "50 %",
                                 "90 %", "99 %", "max");
  for (const Stage& stage : kStages) {
    const Json& percentiles = field(latency, stage.name);
    text += fmt::format("             {:<11}", stage.name);
    for (const char* key : {"p50", "p90", "p99", "max"}) {
      text += fmt::format(" {:>7.2f}", number_field(percentiles, key) / 1000);
    }
    text += fmt::format("  {}\n", stage.meaning);
  }
  return text;
}

std::string status_text(const Json& json) {
  const Json& camera = field(json, "camera");
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
  if (number_field(json, "dropped") > 0) {
    text += fmt::format("dropped      {}\n", drops_text(field(json, "drops")));
  }
  text += latency_text(field(json, "latency_us"));
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
