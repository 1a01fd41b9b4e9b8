#include <fmt/format.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <functional>
#include <memory>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>

#include "calibration/board.hpp"
#include "calibration/camera_file.hpp"
#include "core/necklace.hpp"
#include "daemon/file_pointer.hpp"
#include "daemon/image_file.hpp"
#include "daemon/json_frame.hpp"
#include "simulator/arena.hpp"
#include "simulator/arena_camera.hpp"
#include "simulator/random.hpp"
#include "simulator/renderer.hpp"
#include "tools/board_scene.hpp"
#include "tools/commands.hpp"
#include "tools/frame_output.hpp"
#include "tools/id_list.hpp"
#include "tools/json_truth.hpp"

namespace roundel {
namespace {

constexpr double kRadians = std::numbers::pi / 180;

struct SimulateOptions {
  ArenaOptions arena;
  std::optional<std::int64_t> frames;
  std::string ids;  // of the robots; empty: 1, 2, 3, ...
  bool board = false;
  bool no_corners = false, coded_corners = false, no_clutter = false;
  double tilt_deg = 0, turn_deg = 0, gradient_deg = 0, shadow_deg = 30;
  std::string camera_file, camera_out, truth_file, output;
};

ArenaOptions arena_options(const SimulateOptions& options) {
  ArenaOptions arena = options.arena;
  arena.corners = !options.no_corners;
  arena.corner_kind = options.coded_corners ? MarkerKind::WhyCode : MarkerKind::WhyCon;
  arena.clutter = !options.no_clutter;
  arena.camera_tilt = options.tilt_deg * kRadians;
  arena.camera_turn = options.turn_deg * kRadians;
  if (!options.camera_file.empty()) {
    arena.camera = read_camera_file(options.camera_file).camera;
    arena.image_width = arena.camera->width;
    arena.image_height = arena.camera->height;
  }
  if (!options.ids.empty()) {
    arena.robot_ids = parse_ids(options.ids, NecklaceCode(arena.bits, arena.hamming).id_count());
    arena.robots = static_cast<int>(arena.robot_ids.size());
  }
  Imaging& imaging = arena.imaging;
  imaging.gradient_angle = options.gradient_deg * kRadians;
  imaging.shadow_u = 0.5 * arena.image_width;
  imaging.shadow_v = 0.5 * arena.image_height;
  imaging.shadow_angle = options.shadow_deg * kRadians;
  return arena;
}

// Lines of a text file; every error names it.
class LineWriter {
 public:
  explicit LineWriter(const std::string& path)
      : path_(path), file_(std::fopen(path.c_str(), "we")) {
    if (!file_) {
      fail();
    }
  }

  // The line is in the file when this returns.
  void write(const std::string& line) {
    if (std::fwrite(line.data(), 1, line.size(), file_.get()) != line.size() ||
        std::fflush(file_.get()) != 0) {
      fail();
    }
  }

  void close() {
    if (std::fclose(file_.release()) != 0) {
      fail();
    }
  }

 private:
  [[noreturn]] void fail() const {
    throw std::runtime_error(fmt::format("{} can't be written: {}", path_, std::strerror(errno)));
  }

  std::string path_;
  FilePointer file_;
};

Arena make_arena(const SimulateOptions& options) {
  try {
    return Arena(arena_options(options));
  } catch (const std::invalid_argument& error) {
    throw UsageError(error.what());
  }
}

constexpr std::int64_t kArenaFrames = 300, kBoardFrames = 15, kMaxBoardFrames = 10000;

std::int64_t frame_count(const SimulateOptions& options) {
  return options.frames.value_or(options.board ? kBoardFrames : kArenaFrames);
}

// What is rendered, frame by frame, and what is true of it.
struct Rendering {
  CameraModel camera;
  std::function<void(std::int64_t, GreyImage&)> render;
  std::function<FrameTruth(std::int64_t)> truth;
};

Rendering arena_rendering(const SimulateOptions& options) {
  auto arena = std::make_shared<Arena>(make_arena(options));
  return {arena->camera(),
          [arena](std::int64_t frame, GreyImage& out) { arena->render(frame, out); },
          [arena](std::int64_t frame) { return arena->truth(frame); }};
}

// Views of the calibration board instead of an arena: every frame shows it somewhere else.
Rendering board_rendering(const SimulateOptions& options) {
  try {
    const ArenaOptions arena = checked(arena_options(options));
    const CameraModel camera = arena_camera(arena, arena_in_ceiling_camera(arena));
    Board board;
    board.bits = arena.bits;
    board.hamming = arena.hamming;
    checked(board);
    if (frame_count(options) > kMaxBoardFrames)
      throw UsageError(fmt::format("at most {} views of the board", kMaxBoardFrames));
    const auto poses =
        board_poses(board, camera, static_cast<int>(frame_count(options)), options.arena.seed);
    auto renderer = std::make_shared<Renderer>(camera, arena.imaging);
    const auto pose = [poses](std::int64_t frame) -> const Pose& {
      return poses[static_cast<std::size_t>(frame)];
    };
    const double rate = arena.frame_rate;
    return {camera,
            [=](std::int64_t frame, GreyImage& out) {
              renderer->render(board_scene(board, pose(frame)),
                               derived_seed(arena.seed, static_cast<std::uint64_t>(frame)), out);
            },
            [=](std::int64_t frame) {
              FrameTruth truth = board_truth(board, camera, pose(frame));
              truth.frame = frame;
              truth.time_s = static_cast<double>(frame) / rate;
              return truth;
            }};
  } catch (const std::invalid_argument& error) {
    throw UsageError(error.what());
  }
}

void simulate(const SimulateOptions& options) {
  const Rendering rendering = options.board ? board_rendering(options) : arena_rendering(options);
  const CameraModel& camera = rendering.camera;
  if (!options.camera_out.empty()) {
    write_camera_file(options.camera_out, {"simulator", camera});
  }
  std::optional<LineWriter> truth;
  if (!options.truth_file.empty()) {
    truth.emplace(options.truth_file);
  }
  // What a reader in a pipe looks up is there before the frame that makes it look: camera, truth.
  FrameOutput output(options.output, camera.width, camera.height, options.arena.frame_rate);
  GreyImage frame;
  for (std::int64_t i = 0; i < frame_count(options); ++i) {
    rendering.render(i, frame);
    if (truth) {
      truth->write(json_line(truth_json(rendering.truth(i))));
    }
    output.write(frame.view());
  }
  output.close();
  if (truth) {
    truth->close();
  }
}

void add_arena_options(CLI::App& command, SimulateOptions& options) {
  ArenaOptions& arena = options.arena;
  command.add_option("--robots", arena.robots, "Number of robots")
      ->check(CLI::Range(0, 5000))
      ->capture_default_str();
  command.add_option("--ids", options.ids, "Ids of the robots, as 1-4,9; instead of --robots")
      ->type_name("LIST");
  command.add_option("--bits", arena.bits, "WhyCode bits, 2 to 16; 0: plain WhyCon markers")
      ->capture_default_str();
  command.add_option("--hamming", arena.hamming, "Minimum Hamming distance of the set, 1 to 4")
      ->capture_default_str();
  command.add_option("--diameter", arena.diameter_m, "Outer black diameter, metres")
      ->check(CLI::Range(0.001, 9.0))
      ->capture_default_str();
  command.add_flag("--no-corners", options.no_corners, "Without the four corner markers");
  command.add_flag("--coded-corners", options.coded_corners,
                   "Corner markers with codes: the ids after the robots'");
  command.add_flag("--no-clutter", options.no_clutter, "A bare floor");
  command.add_flag("--occluder", arena.occluder, "A bar that moves to and fro above the robots");
  command.add_flag("--close-passes", arena.close_passes,
                   "Robots pass each other within millimetres");
  command.add_option("--length", arena.length_m, "Of the arena, metres")->capture_default_str();
  command.add_option("--breadth", arena.width_m, "Of the arena, metres")->capture_default_str();
  command.add_option("--min-height", arena.min_height_m, "Of the robots' markers, metres")
      ->capture_default_str();
  command.add_option("--max-height", arena.max_height_m, "Of the robots' markers, metres")
      ->capture_default_str();
  command.add_option("--speed", arena.max_speed, "Of the robots, at most, m/s")
      ->capture_default_str();
}

void add_camera_options(CLI::App& command, SimulateOptions& options) {
  ArenaOptions& arena = options.arena;
  Imaging& imaging = arena.imaging;
  auto* width = command.add_option("--width", arena.image_width, "Of the frames, pixels")
                    ->check(CLI::Range(16, kMaxImageSide))
                    ->capture_default_str();
  auto* height = command.add_option("--height", arena.image_height, "Of the frames, pixels")
                     ->check(CLI::Range(16, kMaxImageSide))
                     ->capture_default_str();
  command.add_option("--camera", options.camera_file, "Intrinsics to render with (YAML)")
      ->excludes(width)
      ->excludes(height)
      ->type_name("FILE");
  command.add_option("--rate", arena.frame_rate, "Frames a second")
      ->check(CLI::Range(0.001, 10000.0))
      ->capture_default_str();
  command.add_option("--camera-height", arena.camera_height_m, "Above the floor, metres")
      ->check(CLI::Range(0.1, 1000.0))
      ->capture_default_str();
  command.add_option("--tilt", options.tilt_deg, "Of the camera, degrees from straight down")
      ->capture_default_str();
  command.add_option("--turn", options.turn_deg, "Of the camera about its axis, degrees")
      ->capture_default_str();
  command.add_option("--exposure", imaging.exposure_s, "Seconds; what moves is smeared")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  command.add_option("--blur", imaging.blur_px, "Of the lens, standard deviation in pixels")
      ->check(CLI::Range(0.0, 10.0))
      ->capture_default_str();
  command.add_option("--noise", imaging.noise_sigma, "Standard deviation in grey levels")
      ->check(CLI::Range(0.0, 60.0))
      ->capture_default_str();
  command.add_option("--gamma", imaging.gamma, "Of the response; 1: linear")
      ->check(CLI::Range(0.2, 5.0))
      ->capture_default_str();
  command.add_flag("--srgb", imaging.srgb, "The response curve of sRGB");
}

void add_light_options(CLI::App& command, SimulateOptions& options) {
  Imaging& imaging = options.arena.imaging;
  command.add_option("--black", imaging.black, "Grey level of ink")
      ->check(CLI::Range(0.0, 255.0))
      ->capture_default_str();
  command.add_option("--white", imaging.white, "Grey level of paper")
      ->check(CLI::Range(0.0, 255.0))
      ->capture_default_str();
  command.add_option("--floor", imaging.floor, "Grey level of the floor")
      ->check(CLI::Range(0.0, 255.0))
      ->capture_default_str();
  command.add_option("--gradient", imaging.gradient, "Relative change of light over the width")
      ->check(CLI::Range(-1.0, 1.0))
      ->capture_default_str();
  command
      .add_option("--gradient-angle", options.gradient_deg,
                  "Direction of growing light, degrees, clockwise from right")
      ->capture_default_str();
  command
      .add_option("--shadow", imaging.shadow_factor,
                  "Light in a hard shadow that begins in the middle, 0 to 1 (1: none)")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  command
      .add_option("--shadow-angle", options.shadow_deg,
                  "Direction into the shadow, degrees, clockwise from right")
      ->capture_default_str();
}

}  // namespace

void add_simulate(CLI::App& app) {
  auto* command = app.add_subcommand(
      "simulate", "Render an arena: frames, camera file, and what is true of every marker");
  auto options = std::make_shared<SimulateOptions>();
  command
      ->add_option("-o,--output", options->output,
                   "FILE.y4m, - for y4m on standard output, or a directory for PNG")
      ->required()
      ->type_name("PATH");
  command->add_option("--frames", options->frames, "How many")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1'000'000'000}))
      ->type_name("N")
      ->default_str(fmt::format("{}, or {} with --board", kArenaFrames, kBoardFrames));
  command->add_flag("--board", options->board,
                    "Views of the board of roundel markers --board instead of an arena; it is at "
                    "another place in every frame");
  command->add_option("--seed", options->arena.seed, "Of motion, clutter and noise")
      ->capture_default_str();
  command->add_option("--camera-out", options->camera_out, "Writes the intrinsics (YAML)")
      ->type_name("FILE");
  command->add_option("--truth", options->truth_file, "Writes the truth, a JSON line a frame")
      ->type_name("FILE");
  add_arena_options(*command, *options);
  add_camera_options(*command, *options);
  add_light_options(*command, *options);
  command->callback([options] { simulate(*options); });
}

}  // namespace roundel
