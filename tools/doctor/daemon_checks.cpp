#include "tools/doctor/daemon_checks.hpp"

#include <fmt/format.h>

#include "daemon/json_fields.hpp"

namespace roundel {
namespace {

using Json = nlohmann::ordered_json;

double wanted_rate(const Configuration& values) {
  switch (values.source) {
    case SourceKind::kSimulator:
      return values.simulator.frame_rate;
    case SourceKind::kFiles:
      return values.files.frame_rate;
    case SourceKind::kCamera:
      return values.camera.frame_rate;
  }
  return 0;
}

Finding source_finding(const Json& camera) {
  const std::string state = string_field(camera, "state");
  const std::string source = string_field(camera, "source");
  if (state == "lost") {
    return {"frames", Verdict::kProblem, fmt::format("{}: no frames come", source),
            "see the log: journalctl -u roundeld"};
  }
  if (state == "starting") {
    return {"frames", Verdict::kWarning, fmt::format("{}: no frame has come yet", source),
            "see the log: journalctl -u roundeld"};
  }
  return {"frames", Verdict::kOk, source, ""};
}

Finding rate_finding(const Json& status, const Configuration& values) {
  constexpr double kEnough = 0.9;
  const double rate = number_field(status, "frame_rate"), wanted = wanted_rate(values);
  const double dropped = number_field(status, "dropped"), frames = number_field(status, "frames");
  const std::string text = fmt::format("{:.1f} a second", rate);
  if (wanted > 0 && rate < kEnough * wanted) {
    return {"frame rate", Verdict::kWarning, fmt::format("{} of {} wanted", text, wanted),
            "a shorter exposure, exposure_dynamic_framerate: false; or the machine is too slow "
            "(latency in roundel status)"};
  }
  constexpr double kFewDropped = 0.01;
  if (dropped > kFewDropped * (frames + dropped)) {
    return {"frame rate", Verdict::kWarning,
            fmt::format("{}, but {:.0f} of {:.0f} frames were left out", text, dropped,
                        frames + dropped),
            "if that number rises (roundel status), the machine is too slow or too busy"};
  }
  return {"frame rate", Verdict::kOk, text, ""};
}

Finding sending_finding(const Json& status) {
  const double unsent = number_field(status, "unsent"), frames = number_field(status, "frames");
  if (unsent == 0) return {"sending", Verdict::kOk, "every frame was given to the network", ""};
  return {"sending", unsent == frames ? Verdict::kProblem : Verdict::kWarning,
          fmt::format("{:.0f} of {:.0f} frames could not be given to the network", unsent, frames),
          "see route and interface"};
}

Finding arena_finding(const Json& arena) {
  const std::string state = string_field(arena, "state");
  const char* const remedy = "roundel calibrate arena --width METRES --height METRES";
  if (state == "moved") {
    return {"arena in use", Verdict::kProblem, "the camera has been moved since it was calibrated",
            remedy};
  }
  if (has_field(arena, "problem")) {
    return {"arena in use", Verdict::kProblem, string_field(arena, "problem"), remedy};
  }
  return {"arena in use", Verdict::kOk, state == "none" ? "none" : "calibrated", ""};
}

}  // namespace

std::vector<Finding> check_status(const Json& status, const Configuration& values) {
  return {source_finding(field(status, "camera")), rate_finding(status, values),
          sending_finding(status), arena_finding(field(status, "arena"))};
}

}  // namespace roundel
