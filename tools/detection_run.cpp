#include "tools/detection_run.hpp"

#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "calibration/arena_file.hpp"
#include "calibration/arena_map.hpp"
#include "calibration/camera_file.hpp"
#include "config/mounts.hpp"
#include "daemon/draw_markers.hpp"
#include "daemon/json_frame.hpp"
#include "tools/commands.hpp"
#include "tools/frame_input.hpp"
#include "tools/frame_text.hpp"
#include "tools/standard_output.hpp"

namespace roundel {
namespace {

// Where the annotated picture of a frame goes: the file given, or one for every frame in a
// directory.
class AnnotatedPath {
 public:
  AnnotatedPath(const std::string& path, const FrameInput& input) : path_(path) {
    single_ = path.ends_with(".png");
    if (single_ && input.is_sequence()) {
      throw UsageError("--annotate " + path + ": several frames need a directory");
    }
    if (!single_ && !path.empty()) {
      std::error_code error;
      std::filesystem::create_directories(path, error);
      if (error) {
        throw std::runtime_error(fmt::format("{} can't be created: {}", path, error.message()));
      }
    }
  }

  bool wanted() const { return !path_.empty(); }

  std::string of(const FrameInput& input) const {
    if (single_) {
      return path_.string();
    }
    const std::string name = input.from_video()
                                 ? fmt::format("frame_{:06}", input.frame())
                                 : std::filesystem::path(input.source()).stem().string() + "_found";
    return (path_ / (name + ".png")).string();
  }

 private:
  std::filesystem::path path_;
  bool single_ = false;
};

// Intrinsics hold for one resolution, tracks for frames of one camera.
class SizeCheck {
 public:
  SizeCheck(FrameSizes sizes, const std::optional<CameraModel>& camera,
            const std::string& camera_file)
      : sizes_(sizes), camera_(camera), camera_file_(camera_file) {}

  // Throws std::runtime_error that names the frame's source.
  void check(const GreyImage& frame, const FrameInput& input) {
    if (camera_) {
      try {
        check_resolution(*camera_, frame.width, frame.height, camera_file_);
      } catch (const std::runtime_error& error) {
        throw std::runtime_error(fmt::format("{}: {}", input.source(), error.what()));
      }
    }
    if (sizes_ == FrameSizes::kOneForAll && width_ != 0 &&
        (frame.width != width_ || frame.height != height_)) {
      throw std::runtime_error(
          fmt::format("{} is {}x{} and follows frames of {}x{}; frames to be tracked have one size",
                      input.source(), frame.width, frame.height, width_, height_));
    }
    width_ = frame.width;
    height_ = frame.height;
  }

 private:
  FrameSizes sizes_;
  const std::optional<CameraModel>& camera_;
  const std::string& camera_file_;
  int width_ = 0, height_ = 0;
};

// Options that go together, before anything is read.
void check_arena_options(const DetectionOptions& options) {
  if (!options.arena_file.empty() && options.camera_file.empty()) {
    throw UsageError("--arena needs --camera: without intrinsics there are no poses");
  }
  for (const std::string& mount : options.mount.mounts) {
    if (!parse_mount(mount, {})) {
      throw UsageError(fmt::format(
          "--mount {}: must be an id with height, offset_x, offset_y or rotation, as in \"7 "
          "height=0.12\"",
          mount));
    }
  }
}

// From the camera to the arena, for recorded frames: which camera took them is not known, but
// resolution and lens must be those of the calibration.
class ArenaCoordinates {
 public:
  ArenaCoordinates(const DetectionOptions& options, const CameraModel& camera) {
    const ArenaCalibration calibration = read_arena_file(options.arena_file);
    const std::string why = mismatch(calibration.camera, {"", "", camera});
    if (!why.empty()) {
      throw std::runtime_error(
          fmt::format("{} is not for {}: {}", options.arena_file, options.camera_file, why));
    }
    map_.emplace(calibration, options.arena_mode == "3d" ? ArenaMode::k3D : ArenaMode::k2D,
                 marker_mounts(options.mount));
  }

  std::span<const ArenaPose> locate(std::span<const Marker> markers) {
    poses_.clear();
    for (const Marker& marker : markers) {
      poses_.push_back(map_->locate(marker));
    }
    return poses_;
  }

 private:
  std::optional<ArenaMap> map_;
  std::vector<ArenaPose> poses_;
};

FindMarkers checked_finder(const MakeFinder& make_finder, const DetectionOptions& options,
                           const std::optional<CameraModel>& camera) {
  try {
    return make_finder(options.parameters, camera);
  } catch (const std::invalid_argument& error) {
    throw UsageError(error.what());  // parameters out of range
  }
}

}  // namespace

void run_detection(const DetectionOptions& options, FrameSizes sizes,
                   const MakeFinder& make_finder) {
  check_arena_options(options);
  FrameInput input(options.files);
  const AnnotatedPath annotated(options.annotate, input);
  checked_finder(make_finder, options, std::nullopt);  // parameters out of range: before waiting

  GreyImage frame;
  bool more = input.next(frame);
  // After the first frame: in a pipe, the program that makes the frames may make the camera file
  // too.
  std::optional<CameraModel> camera;
  if (!options.camera_file.empty()) {
    camera = read_camera_file(options.camera_file).camera;
  }
  std::optional<ArenaCoordinates> coordinates;
  if (!options.arena_file.empty()) {
    coordinates.emplace(options, *camera);
  }
  const FindMarkers find = checked_finder(make_finder, options, camera);
  SizeCheck size_check(sizes, camera, options.camera_file);
  for (; more; more = input.next(frame)) {
    size_check.check(frame, input);
    const auto start = std::chrono::steady_clock::now();
    const std::span<const Marker> markers = find(frame.view());
    const std::chrono::duration<double, std::micro> elapsed =
        std::chrono::steady_clock::now() - start;
    const std::span<const ArenaPose> arena =
        coordinates ? coordinates->locate(markers) : std::span<const ArenaPose>();
    const FrameInfo info{input.source(), input.frame(), input.utime(), elapsed.count()};
    print(options.json ? json_line(frame_json(info, markers, arena))
                       : frame_text(info, markers, arena));
    if (annotated.wanted()) {
      save_annotated_png(annotated.of(input), frame.view(), markers, camera,
                         options.parameters.diameter_m);
    }
  }
}

}  // namespace roundel
