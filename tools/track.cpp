#include <memory>

#include "core/tracker.hpp"
#include "tools/commands.hpp"
#include "tools/detection_run.hpp"

namespace roundel {

void add_track(CLI::App& app) {
  auto* command = app.add_subcommand("track", "Follow markers through consecutive frames");
  const auto options = add_detection_options(
      *command, "Images in order, a .y4m file, or - for y4m on standard input");
  command->callback([options] {
    const auto make_tracker = [](const DetectorParameters& parameters,
                                 const std::optional<CameraModel>& camera) -> FindMarkers {
      auto tracker = std::make_shared<Tracker>(parameters, camera);
      return [tracker](const LumaView& frame) { return tracker->track(frame); };
    };
    run_detection(*options, FrameSizes::kOneForAll, make_tracker);
  });
}

}  // namespace roundel
