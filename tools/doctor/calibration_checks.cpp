#include "tools/doctor/calibration_checks.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <filesystem>
#include <stdexcept>

#include "calibration/arena_file.hpp"
#include "calibration/camera_file.hpp"

namespace roundel {
namespace {

constexpr int kOldDays = 365;
constexpr const char* kCalibrateCamera =
    "roundel calibrate camera, and name its file in camera.calibration";

int days_since_change(const std::string& path, std::chrono::system_clock::time_point now) {
  struct stat information {};
  if (::stat(path.c_str(), &information) != 0) return 0;
  const auto changed = std::chrono::system_clock::from_time_t(information.st_mtime);
  return static_cast<int>(std::chrono::duration_cast<std::chrono::hours>(now - changed).count() /
                          24);
}

}  // namespace

Finding check_lens(const Configuration& values, int width, int height,
                   std::chrono::system_clock::time_point now) {
  const std::string& path = values.camera.calibration;
  if (path.empty()) {
    if (values.source == SourceKind::kSimulator) {
      return {"lens", Verdict::kOk, "the simulator knows its own", ""};
    }
    return {"lens", Verdict::kProblem, "the camera is not calibrated, so there are no poses",
            kCalibrateCamera};
  }
  try {
    const CameraModel camera = read_camera_file(path).camera;
    if (width > 0) check_resolution(camera, width, height, path);
    const int days = days_since_change(path, now);
    const std::string text =
        fmt::format("{}, {}x{}, {} days old", path, camera.width, camera.height, days);
    if (days <= kOldDays) return {"lens", Verdict::kOk, text, ""};
    return {"lens", Verdict::kWarning, text,
            "if focus, zoom, resolution or crop have been changed since: roundel calibrate camera"};
  } catch (const std::runtime_error& error) {
    return {"lens", Verdict::kProblem, error.what(), kCalibrateCamera};
  }
}

Finding check_arena(const Configuration& values) {
  const std::string& path = values.arena.file;
  if (std::error_code error; !std::filesystem::exists(path, error)) {
    return {"arena", Verdict::kOk, "not calibrated: poses are in the camera's frame alone", ""};
  }
  const char* const remedy = "roundel calibrate arena --width METRES --height METRES";
  try {
    const ArenaCalibration calibration = read_arena_file(path);
    const std::string text =
        fmt::format("{}, {} x {} m, made {}", path, calibration.request.width_m,
                    calibration.request.height_m, calibration.date);
    if (values.camera.calibration.empty()) return {"arena", Verdict::kOk, text, ""};
    ArenaCamera camera = calibration.camera;  // only the intrinsics can differ here
    camera.intrinsics = read_camera_file(values.camera.calibration).camera;
    const std::string why = mismatch(calibration.camera, camera);
    if (why.empty()) return {"arena", Verdict::kOk, text, ""};
    return {"arena", Verdict::kProblem, fmt::format("{} is not used: {}", path, why), remedy};
  } catch (const std::runtime_error& error) {
    return {"arena", Verdict::kProblem, error.what(), remedy};
  }
}

}  // namespace roundel
