#include "tools/doctor/camera_checks.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <sstream>

#include "daemon/capture/camera_mode.hpp"
#include "daemon/capture/device_controls.hpp"
#include "daemon/setup.hpp"

namespace roundel {
namespace {

namespace fs = std::filesystem;

// What a USB bus carries beside everything else it has to do.
constexpr double kShareOfUsb = 0.8;

// Megabits a second of the USB bus that the camera is on; 0: it is on none, or that is not known.
double usb_speed(const MachineRoot& root, const CameraInformation& camera) {
  const std::string name = fs::path(camera.node).filename().string();
  std::error_code error;
  // .../usb1/1-1/1-1:1.0: the device that has a speed is above the interface.
  const fs::path device =
      fs::canonical(root.of("/sys/class/video4linux/" + name + "/device"), error);
  if (error) return 0;
  const MachineRoot above{device.parent_path().string()};
  double speed = 0;
  std::istringstream(above.read("/speed")) >> speed;
  return speed;
}

Finding bandwidth(const MachineRoot& root, const CameraInformation& camera, const ModeChoice& mode,
                  double frame_rate) {
  const double usb = usb_speed(root, camera);
  if (usb == 0 || mode.format->bits_per_pixel == 0 || mode.width == 0) {
    return {"bandwidth", Verdict::kOk, "no USB bus that its frames could fill", ""};
  }
  // Planar formats carry half as much chroma besides.
  const double bits = mode.format->bits_per_pixel == 8 && fourcc_name(mode.format->fourcc) != "GREY"
                          ? 12
                          : mode.format->bits_per_pixel;
  const double needed = bits * mode.width * mode.height * frame_rate / 1e6;
  if (needed > kShareOfUsb * usb) {
    return {"bandwidth", Verdict::kWarning,
            fmt::format("{}x{} {} at {:.4g} frames/s are {:.0f} Mbit/s, its USB bus has {:.0f}",
                        mode.width, mode.height, fourcc_name(mode.format->fourcc), frame_rate,
                        needed, usb),
            "use a USB 3 port, MJPG (camera.format), or a smaller size or frame rate"};
  }
  return {"bandwidth", Verdict::kOk,
          fmt::format("{:.0f} of its USB bus's {:.0f} Mbit/s are needed", needed, usb), ""};
}

// The values that a running roundeld sets are those that count for it.
bool is_configured(const CameraSettings& settings, const Control& control) {
  return settings.controls.find(control.name) != settings.controls.end();
}

Finding automatics(const std::vector<Control>& controls, const CameraSettings& settings) {
  std::vector<std::string> on;
  std::vector<std::string> remedies;
  for (const Control& control : controls) {
    if (is_configured(settings, control)) continue;
    if (control.name == "auto_exposure" && value_text(control) != "Manual Mode") {
      on.emplace_back("exposure");
      remedies.emplace_back("auto_exposure: Manual Mode, exposure_time_absolute: 50");
    } else if (control.name == "exposure_dynamic_framerate" && control.value != 0) {
      on.emplace_back("frame rate by exposure");
      remedies.emplace_back("exposure_dynamic_framerate: false");
    } else if (control.name == "focus_automatic_continuous" && control.value != 0) {
      on.emplace_back("focus");
      remedies.emplace_back("focus_automatic_continuous: false");
    }
  }
  if (on.empty()) return {"automatics", Verdict::kOk, "none is on that does harm", ""};
  return {"automatics", Verdict::kWarning,
          fmt::format("the camera's own control of {} is on: pictures blur, frames come slower in "
                      "the dark, the calibration drifts",
                      fmt::join(on, ", ")),
          fmt::format("set camera.controls: {{{}}}", fmt::join(remedies, ", "))};
}

Finding mode_finding(const CameraInformation& camera, const ModeChoice& mode,
                     const std::vector<OfferedFormat>& offered, double wanted) {
  double fastest = 0;
  for (const OfferedFormat& format : offered) {
    for (const OfferedSize& size : format.sizes) {
      if (format.fourcc == mode.format->fourcc && size.width == mode.width &&
          size.height == mode.height) {
        fastest = size.fastest();
      }
    }
  }
  const std::string text =
      fmt::format("{}: {}x{} {}, {}", describe(camera), mode.width, mode.height,
                  fourcc_name(mode.format->fourcc), how_it_is_read(*mode.format));
  constexpr double kSameRate = 0.99;
  if (fastest > 0 && fastest < kSameRate * wanted) {
    return {
        "camera", Verdict::kWarning,
        fmt::format("{}, but at most {:.4g} frames/s of the {:.4g} wanted", text, fastest, wanted),
        "choose a smaller size or another format (roundel cameras), or lower camera.frame_rate"};
  }
  return {"camera", Verdict::kOk, text, ""};
}

}  // namespace

std::vector<Finding> check_camera(const MachineRoot& root, const CameraSystem& system,
                                  const LoadedConfiguration& configuration) {
  const Configuration& values = configuration.values;
  if (values.source != SourceKind::kCamera) {
    return {{"camera", Verdict::kOk, "none is needed: the source of frames is another", ""}};
  }
  CameraInformation camera;
  try {
    const CameraParameters parameters = camera_parameters(configuration);
    camera = choose_camera(system.cameras(), parameters.choice);
    const std::unique_ptr<VideoDevice> device = system.open(camera.node);
    const std::vector<OfferedFormat> offered = offered_formats(*device, camera.multiplanar);
    const ModeChoice mode = choose_mode(offered, parameters.mode);
    return {mode_finding(camera, mode, offered, parameters.mode.frame_rate),
            bandwidth(root, camera, mode, parameters.mode.frame_rate),
            automatics(list_controls(*device), values.camera)};
  } catch (const CameraAbsent& error) {
    return {{"camera", Verdict::kProblem, error.what(),
             "plug it in, see roundel cameras, and camera.device or camera.match_ in the "
             "configuration"}};
  } catch (const CameraError& error) {
    return {{"camera", Verdict::kProblem, error.what(),
             "see docs/guide/camera.md; for permission: sudo usermod -aG video $USER, then log in "
             "again"}};
  }
}

}  // namespace roundel
