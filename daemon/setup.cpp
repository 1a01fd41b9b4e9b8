#include "daemon/setup.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <system_error>

#include "calibration/camera_file.hpp"
#include "daemon/capture/camera_source.hpp"
#include "daemon/files_source.hpp"
#include "daemon/simulator_source.hpp"
#include "daemon/worker_pool.hpp"
#include "transport/clock.hpp"
#include "transport/lcm_url.hpp"

namespace roundel {
namespace {

std::unique_ptr<FrameSource> make_simulator(const LoadedConfiguration& configuration) {
  const SimulatorSettings& settings = configuration.values.simulator;
  const DetectorParameters& markers = configuration.values.detector;
  ArenaOptions options;
  options.image_width = settings.width;
  options.image_height = settings.height;
  options.frame_rate = settings.frame_rate;
  options.seed = static_cast<std::uint64_t>(settings.seed);
  options.robots = settings.robots;
  options.bits = markers.bits;
  options.hamming = markers.hamming;
  options.diameter_m = markers.diameter_m;
  options.corners = settings.corner_markers;
  options.length_m = settings.arena_length;
  options.width_m = settings.arena_width;
  options.camera_height_m = settings.camera_height;
  options.clutter = settings.clutter;
  options.imaging.blur_px = settings.blur;
  options.imaging.noise_sigma = settings.noise;
  options.imaging.exposure_s = settings.exposure;
  const std::string& calibration = configuration.values.camera.calibration;
  if (!calibration.empty()) {
    options.camera = read_camera_file(calibration).camera;
    check_resolution(*options.camera, settings.width, settings.height, calibration);
  }
  try {
    return std::make_unique<SimulatorSource>(options);
  } catch (const std::invalid_argument& error) {
    throw configuration.error("simulator", error.what());
  }
}

std::uint32_t fourcc_of(const LoadedConfiguration& configuration) {
  const std::string& name = configuration.values.camera.format;
  if (name == "auto") return 0;
  const std::optional<std::uint32_t> fourcc = parse_fourcc(name);
  if (fourcc && find_pixel_format(*fourcc) != nullptr) return *fourcc;
  std::vector<std::string> names = {"auto"};
  names.reserve(pixel_formats().size() + 1);
  for (const PixelFormat& format : pixel_formats()) names.push_back(fourcc_name(format.fourcc));
  throw configuration.error("camera.format",
                            fmt::format("\"{}\" is no format that can be read; accepted: {}", name,
                                        fmt::join(names, ", ")));
}

// A pipe would be waited for, and the frame loop with it.
void require_files(const LoadedConfiguration& configuration, const std::string& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) return;  // who reads them knows more
  if (std::filesystem::is_regular_file(status) || std::filesystem::is_directory(status)) return;
  throw configuration.error("files.paths", fmt::format("{} is neither a file nor a folder", path));
}

}  // namespace

CameraParameters camera_parameters(const LoadedConfiguration& configuration) {
  const CameraSettings& settings = configuration.values.camera;
  CameraParameters parameters;
  parameters.choice = {settings.device, settings.match_card, settings.match_bus,
                       settings.match_serial};
  parameters.mode = {
      fourcc_of(configuration),
      settings.width,
      settings.height,
      settings.frame_rate,
      {settings.crop_left, settings.crop_top, settings.crop_width, settings.crop_height}};
  parameters.controls = settings.controls;
  parameters.buffers = settings.buffers;
  parameters.timeout_s = settings.timeout;
  return parameters;
}

std::unique_ptr<FrameSource> make_source(const LoadedConfiguration& configuration) {
  if (configuration.values.source == SourceKind::kSimulator) return make_simulator(configuration);
  if (configuration.values.source == SourceKind::kCamera) {
    return std::make_unique<CameraSource>(camera_parameters(configuration));
  }
  const FilesSettings& files = configuration.values.files;
  for (const std::string& path : files.paths) require_files(configuration, path);
  return std::make_unique<FilesSource>(FilesParameters{files.paths, files.frame_rate, files.loop});
}

std::optional<CameraModel> make_camera(const LoadedConfiguration& configuration,
                                       const FrameSource& source) {
  if (source.camera()) return source.camera();
  const std::string& path = configuration.values.camera.calibration;
  if (path.empty()) return std::nullopt;
  const CameraModel camera = read_camera_file(path).camera;
  // A camera tells its resolution with the first frame.
  if (source.width() > 0) check_resolution(camera, source.width(), source.height(), path);
  return camera;
}

Tracker make_tracker(const LoadedConfiguration& configuration,
                     const std::optional<CameraModel>& camera) {
  try {
    Tracker tracker(configuration.values.detector, camera);
    tracker.time_stages(monotonic_ns);
    if (configuration.values.tracking_threads > 1) {
      tracker.share_work(std::make_shared<WorkerPool>(configuration.values.tracking_threads));
    }
    return tracker;
  } catch (const std::system_error& error) {
    throw configuration.error("detector.threads", fmt::format("{} threads can't be started: {}",
                                                              configuration.values.tracking_threads,
                                                              error.code().message()));
  } catch (const std::invalid_argument& error) {
    throw configuration.error("detector", error.what());
  }
}

Broadcast make_broadcast(const LoadedConfiguration& configuration) {
  check_broadcast(configuration);
  return {configuration.values.lcm, configuration.values.camera.name};
}

void check_broadcast(const LoadedConfiguration& configuration) {
  try {
    BroadcastTargets::check_copies(configuration.values.lcm);
  } catch (const LcmUrlError& error) {
    throw configuration.error("lcm.copies", error.what());
  }
  try {
    Broadcast::check(configuration.values.lcm, configuration.values.camera.name);
  } catch (const LcmUrlError& error) {
    throw configuration.error("lcm.url", error.what());
  } catch (const std::invalid_argument& error) {
    throw configuration.error("lcm.max_datagram", error.what());
  }
}

bool same_camera(const std::optional<CameraModel>& a, const std::optional<CameraModel>& b) {
  if (!a || !b) return !a && !b;
  const auto values = [](const CameraModel& c) {
    const Distortion& d = c.distortion;
    return std::array<double, 11>{static_cast<double>(c.width),
                                  static_cast<double>(c.height),
                                  c.fx,
                                  c.fy,
                                  c.cx,
                                  c.cy,
                                  d.k1,
                                  d.k2,
                                  d.p1,
                                  d.p2,
                                  d.k3};
  };
  return values(*a) == values(*b);
}

}  // namespace roundel
