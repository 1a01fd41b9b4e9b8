#include <fmt/format.h>

#include <ctime>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "calibration/atomic_file.hpp"
#include "calibration/board.hpp"
#include "calibration/camera_file.hpp"
#include "calibration/view_advice.hpp"
#include "calibration/view_collector.hpp"
#include "daemon/json_frame.hpp"
#include "tools/board_options.hpp"
#include "tools/calibrate.hpp"
#include "tools/camera_report.hpp"
#include "tools/commands.hpp"
#include "tools/control_client.hpp"
#include "tools/frame_input.hpp"
#include "tools/live_views.hpp"
#include "tools/standard_output.hpp"

namespace roundel {
namespace {

struct CalibrateCameraOptions {
  std::vector<std::string> files;  // none: live
  LiveOptions live{kDefaultControlSocket, 600, false};
  Board board;
  bool no_k3 = false, exact_board = false;
  std::string output, name = "camera";
  bool json = false;
};

std::string name_of(const FrameInput& input) {
  return input.from_video() ? fmt::format("{} frame {}", input.source(), input.frame())
                            : input.source();
}

// Intrinsics hold for one resolution.
void check_size(const GreyImage& frame, const ViewCollector& collector, const FrameInput& input) {
  if (frame.width == collector.width() && frame.height == collector.height()) return;
  throw std::runtime_error(fmt::format(
      "{} is {}x{}, but the pictures before it are {}x{}; a calibration holds for one resolution",
      name_of(input), frame.width, frame.height, collector.width(), collector.height()));
}

// Looks at all frames: pictures are taken as somebody chose them, from videos the good ones.
ViewCollector collect(const std::vector<std::string>& files, CameraReport& report) {
  FrameInput input(files);
  std::optional<ViewCollector> collector;
  GreyImage frame;
  while (input.next(frame)) {
    if (!collector) collector.emplace(report.board, frame.width, frame.height);
    check_size(frame, *collector, input);
    const std::string name = name_of(input);
    const auto outcome = input.from_video() ? collector->offer(frame.view(), name)
                                            : collector->take(frame.view(), name);
    const bool used =
        outcome == ViewCollector::Outcome::kTaken || outcome == ViewCollector::Outcome::kReplaced;
    if (!used && !input.from_video()) report.skipped.push_back({name, describe(outcome)});
  }
  if (!collector) throw std::runtime_error("the video has no frame");
  return std::move(*collector);
}

// Views that were seen but are not in the result have too many outliers.
void tell_left_out(CameraReport& report) {
  std::vector<bool> used(report.sources.size(), false);
  for (const ViewResult& view : report.calibration.result.views)
    used[static_cast<std::size_t>(view.picture)] = true;
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (!used[i])
      report.skipped.push_back({report.sources[i], "its markers contradict the other views"});
  }
}

std::string today() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  return fmt::format("{:04}-{:02}-{:02}", utc.tm_year + 1900, utc.tm_mon + 1, utc.tm_mday);
}

void calibrate_camera(const CalibrateCameraOptions& options) {
  CameraReport report;
  report.board = checked_board(options.board);
  LiveOptions live = options.live;
  live.quiet = options.json;
  // Better now than after ten minutes in front of the camera.
  if (!options.output.empty()) require_writable(options.output);
  const ViewCollector collector =
      options.files.empty() ? collect_live(report.board, live) : collect(options.files, report);
  require_board(collector.tally(), report.board);
  std::vector<LumaView> pictures;
  std::vector<BoardView> views;
  for (const CollectedView& view : collector.views()) {
    pictures.push_back(view.picture.view());
    views.push_back(view.sighting.view);
    report.sources.push_back(view.name);
  }
  const auto shown =
      options.files.empty() ? views.size() : static_cast<std::size_t>(collector.tally().pictures);
  require_views(views, shown, collector.width(), collector.height());
  IntrinsicOptions intrinsic;
  intrinsic.estimate_k3 = !options.no_k3;
  intrinsic.exact_board = options.exact_board;
  report.calibration = calibrate_from_pictures(pictures, report.board, intrinsic);
  const CameraModel& camera = report.calibration.result.camera;
  report.advice = view_advice(views, camera);
  tell_left_out(report);
  if (!options.output.empty()) {
    write_camera_file(options.output, {options.name, camera},
                      camera_file_comments(report, today()));
  }
  if (options.json) {
    print(json_line(camera_report_json(report)));
    return;
  }
  print(camera_report_text(report));
  print(options.output.empty() ? "not saved: give -o FILE.yaml\n"
                               : fmt::format("saved as {}\n", options.output));
}

}  // namespace

void add_calibrate_camera(CLI::App& calibrate) {
  auto* command = calibrate.add_subcommand(
      "camera",
      "Intrinsics from pictures of the board that roundel markers --board prints, live "
      "from a running roundeld or from files");
  auto options = std::make_shared<CalibrateCameraOptions>();
  auto* const files = command->add_option(
      "FILE", options->files,
      "Some 15 pictures of the board (PNG, JPEG, PGM), or .y4m videos (- for standard input), out "
      "of which the best views are chosen; none: what the camera of a running roundeld sees");
  add_socket_option(*command, options->live.socket)->excludes(files);
  command
      ->add_option("--time-limit", options->live.time_limit_s,
                   "Seconds that views are collected from roundeld for, if nothing is missing "
                   "sooner")
      ->check(CLI::Range(1.0, 86400.0))
      ->capture_default_str()
      ->excludes(files);
  command
      ->add_option("-o,--output", options->output,
                   "Writes the camera file (ROS camera_info YAML), which --camera reads")
      ->type_name("FILE");
  command->add_option("--name", options->name, "camera_name in the file")->capture_default_str();
  add_board_options(*command, options->board);
  command->add_flag("--no-k3", options->no_k3, "Lens without the third radial coefficient");
  command->add_flag("--exact-board", options->exact_board,
                    "The board is a flat plate or a screen whose markers lie exactly where they "
                    "should; without, their places are estimated too");
  command->add_flag("--json", options->json, "One JSON object");
  command->callback([options] { calibrate_camera(*options); });
}

}  // namespace roundel
