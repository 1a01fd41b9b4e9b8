#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <memory>
#include <thread>

#include "daemon/json_fields.hpp"
#include "daemon/json_frame.hpp"
#include "tools/arena_report.hpp"
#include "tools/calibrate.hpp"
#include "tools/commands.hpp"
#include "tools/control_client.hpp"
#include "tools/standard_output.hpp"

namespace roundel {
namespace {

using Json = nlohmann::ordered_json;

struct CalibrateArenaOptions {
  std::string socket = kDefaultControlSocket;
  double width = 0, height = 0;
  std::string origin = "bottom-left";
  std::vector<int> ids;
  std::vector<std::string> anchors;
  double corner_height = 0, corner_diameter = 0, certainty_mm = 0.3, time_limit = 30,
         tolerance_mm = 0;
  bool json = false;
};

// "9=1.5,0.25"
Json anchor_json(const std::string& text) {
  int id = 0, end = 0;
  double x = 0, y = 0;
  const int read = std::sscanf(text.c_str(), "%d=%lf,%lf%n", &id, &x, &y, &end);
  if (read != 3 || static_cast<std::size_t>(end) != text.size()) {
    throw UsageError(fmt::format("--anchor {}: must read ID=X,Y, as in 9=1.5,0.25", text));
  }
  return {{"id", id}, {"x", x}, {"y", y}};
}

Json request_json(const CalibrateArenaOptions& options) {
  Json request = {{"width", options.width},
                  {"height", options.height},
                  {"origin", options.origin},
                  {"ids", options.ids},
                  {"anchors", Json::array()},
                  {"corner_height", options.corner_height},
                  {"certainty", options.certainty_mm / 1000},
                  {"time_limit", options.time_limit}};
  for (const std::string& anchor : options.anchors) {
    request["anchors"].push_back(anchor_json(anchor));
  }
  if (options.corner_diameter > 0) request["corner_diameter"] = options.corner_diameter;
  if (options.tolerance_mm > 0) request["tolerance"] = options.tolerance_mm / 1000;
  return request;
}

// One line on standard error: over itself on a terminal, else only when something else is missing.
class ProgressLine {
 public:
  ~ProgressLine() {
    if (terminal_ && !last_.empty()) std::fputc('\n', stderr);
  }
  ProgressLine() = default;
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void show(const Json& run) {
    constexpr std::size_t kColumns = 60;
    const std::string missing = string_field(run, "text").substr(0, kColumns);
    if (terminal_) {
      fmt::print(stderr, "\r\x1b[K{:.0f} frames, {:.0f} s: {}", number_field(run, "frames"),
                 number_field(run, "elapsed_s"), missing);
    } else if (missing != last_) {
      fmt::print(stderr, "{}\n", missing);
    }
    last_ = missing;
    std::fflush(stderr);
  }

 private:
  bool terminal_ = ::isatty(STDERR_FILENO) == 1;
  std::string last_;
};

// The state of GET /v1/calibration when it has ended.
Json wait_for_end(const ControlClient& client, bool quiet) {
  constexpr auto kPeriod = std::chrono::milliseconds(200);
  ProgressLine line;
  for (;;) {
    Json state = client.get("/v1/calibration");
    const Json& run = field(state, "run");
    if (string_field(run, "state") != "running") return state;
    if (!quiet) line.show(run);
    std::this_thread::sleep_for(kPeriod);
  }
}

void calibrate_arena(const CalibrateArenaOptions& options) {
  const ControlClient client(options.socket);
  client.send("POST", "/v1/calibration/arena", request_json(options));
  const Json state = wait_for_end(client, options.json);
  const Json& run = field(state, "run");
  if (string_field(run, "state") != "done") throw std::runtime_error(string_field(run, "text"));
  const Json& arena = field(state, "arena");
  print(options.json ? json_line(arena) : arena_report(arena));
}

}  // namespace

void add_calibrate_arena(CLI::App& calibrate) {
  auto* command = calibrate.add_subcommand(
      "arena", "Find the arena by markers in its corners; roundeld keeps and uses the result");
  const auto options = std::make_shared<CalibrateArenaOptions>();
  add_socket_option(*command, options->socket);
  command->add_option("--width", options->width, "Along x, between the corner markers' centres")
      ->required()
      ->type_name("METRES");
  command->add_option("--height", options->height, "Along y, between the corner markers' centres")
      ->required()
      ->type_name("METRES");
  command
      ->add_option("--origin", options->origin,
                   "Corner in the image that is (0, 0): bottom-left, bottom-right, top-right or "
                   "top-left; x runs from it counter-clockwise")
      ->check(CLI::IsMember({"bottom-left", "bottom-right", "top-right", "top-left"}))
      ->capture_default_str();
  command
      ->add_option("--ids", options->ids,
                   "Ids of the corners, counter-clockwise from the origin (default: the four "
                   "outermost markers)")
      ->delimiter(',')
      ->type_name("A,B,C,D");
  command
      ->add_option("--anchor", options->anchors,
                   "One more fixed marker and its place in metres; may be repeated")
      ->type_name("ID=X,Y")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command
      ->add_option("--corner-height", options->corner_height,
                   "Of the fixed markers' faces above the floor, metres")
      ->capture_default_str();
  command->add_option("--corner-diameter", options->corner_diameter,
                      "Of the fixed markers' black discs, metres (default: marker.diameter)");
  command
      ->add_option("--certainty", options->certainty_mm,
                   "Standard deviation on the floor to be reached, millimetres")
      ->check(CLI::Range(0.001, 1000.0))
      ->capture_default_str();
  command
      ->add_option("--time-limit", options->time_limit,
                   "Seconds, from the first frame on; so long does it wait for that, too")
      ->check(CLI::Range(0.1, 3600.0))
      ->capture_default_str();
  command->add_option("--tolerance", options->tolerance_mm,
                      "Residual that a corner may have, millimetres (default: 0.2 % of the "
                      "diagonal, at least 3)");
  command->add_flag("--json", options->json, "The result as one JSON object");
  command->callback([options] { calibrate_arena(*options); });
}

void add_calibrate_restore(CLI::App& calibrate) {
  auto* command = calibrate.add_subcommand(
      "restore", "Use the arena's calibration from before the one in use; again: and back");
  const auto socket = std::make_shared<std::string>(kDefaultControlSocket);
  add_socket_option(*command, *socket);
  command->callback([socket] {
    const Json answer =
        ControlClient(*socket).send("POST", "/v1/calibration/restore", Json::object());
    print(fmt::format("The calibration of {} is in use.\n", string_field(answer, "date")));
  });
}

}  // namespace roundel
