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
      .add_option("--arena", options->arena_file,
                  "Arena calibration: adds arena coordinates (not supported yet)")
      ->type_name("FILE");
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
