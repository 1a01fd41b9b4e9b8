#include <memory>

#include "core/detector.hpp"
#include "tools/commands.hpp"
#include "tools/detection_run.hpp"

namespace roundel {

void add_detect(CLI::App& app) {
  auto* command =
      app.add_subcommand("detect", "Find markers in images, each on its own (PNG, JPEG, PGM)");
  const auto options = add_detection_options(
      *command, "Images; .y4m files and - (y4m on standard input) give their frames");
  command->callback([options] {
    const auto make_detector = [](const DetectorParameters& parameters,
                                  const std::optional<CameraModel>& camera) -> FindMarkers {
      auto detector = std::make_shared<Detector>(parameters, camera);
      return [detector](const LumaView& frame) { return detector->detect(frame); };
    };
    run_detection(*options, FrameSizes::kAny, make_detector);
  });
}

}  // namespace roundel
