#include "tools/detection_options.hpp"

#include <limits>

namespace roundel {

std::shared_ptr<DetectionOptions> add_detection_options(CLI::App& command,
                                                        const std::string& files_help) {
  auto options = std::make_shared<DetectionOptions>();
  DetectorParameters& parameters = options->parameters;
  command.add_option("FILE", options->files, files_help)->required();
  command
      .add_option("--camera", options->camera_file,
                  "Intrinsics (ROS camera_info or OpenCV YAML); without, no poses")
      ->type_name("FILE");
  command.add_option("--diameter", parameters.diameter_m, "Outer black diameter, metres")
      ->check(CLI::Range(0.001, 100.0))
      ->type_name("METRES")
      ->capture_default_str();
  command.add_option("--bits", parameters.bits, "WhyCode bits, 2 to 16; 0: plain WhyCon only")
      ->type_name("N")
      ->capture_default_str();
  command
      .add_option("--hamming", parameters.hamming, "Minimum Hamming distance of the set, 1 to 4")
      ->type_name("N")
      ->capture_default_str();
  command
      .add_option("--inner-ratio", parameters.inner_ratio,
                  "Of plain markers: white over black diameter; 0: not known")
      ->check(CLI::Range(0.2, 0.7) | CLI::IsMember({0.0}))
      ->type_name("RATIO")
      ->default_str("0.4098");
  command
      .add_option("--arena", options->arena_file,
                  "Arena calibration (roundel calibrate arena): adds arena coordinates")
      ->type_name("FILE");
  command
      .add_option("--arena-mode", options->arena_mode,
                  "2d: markers at a known height above the floor; 3d: anywhere")
      ->check(CLI::IsMember({"2d", "3d"}))
      ->capture_default_str();
  command
      .add_option("--marker-height", options->mount.height,
                  "Of the markers above the floor, metres; 2d only")
      ->check(CLI::Range(0.0, 10.0))
      ->type_name("METRES")
      ->capture_default_str();
  command
      .add_option("--mount", options->mount.mounts,
                  "A robot that wears its marker in another way, as in \"7 height=0.12\"; may be "
                  "repeated")
      ->type_name("TEXT")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command
      .add_option_function<std::string>(
          "--response",
          [options](const std::string& name) {
            const auto response = ResponseCurve::named(name);
            if (!response && name != "auto") {
              throw CLI::ValidationError(
                  "--response", "'" + name +
                                    "' is no response curve; accepted: auto, linear, srgb, or a "
                                    "gamma from 0.2 to 5");
            }
            options->parameters.response = response;
          },
          "How the camera turned light into grey levels: linear, srgb, a gamma, or auto: as the "
          "markers tell")
      ->type_name("CURVE")
      ->default_str("auto");
  command.add_option("--max-markers", parameters.max_markers, "More are not reported")
      ->check(CLI::Range(1, std::numeric_limits<int>::max()))
      ->type_name("N")
      ->capture_default_str();
  command.add_flag("--json", options->json, "One JSON object a frame");
  command
      .add_option("--annotate", options->annotate,
                  "Picture with the found markers drawn in: FILE.png, or a directory for several")
      ->type_name("PATH");
  return options;
}

}  // namespace roundel
