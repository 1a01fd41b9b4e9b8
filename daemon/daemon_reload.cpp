// A new configuration for a daemon that runs.
#include <fmt/ranges.h>

#include <algorithm>
#include <initializer_list>
#include <string_view>

#include "config/fields.hpp"
#include "daemon/daemon.hpp"
#include "daemon/log.hpp"
#include "daemon/setup.hpp"

namespace roundel {
namespace {

// The keys that a source is made from; beginnings of them.
std::initializer_list<std::string_view> source_sections(SourceKind kind) {
  // Robots wear the markers of the configuration.
  static const std::initializer_list<std::string_view> simulator = {
      "simulator.", "marker.diameter", "marker.bits", "marker.hamming", "camera.calibration"};
  static const std::initializer_list<std::string_view> files = {"files."};
  static const std::initializer_list<std::string_view> camera = {
      "camera.device",     "camera.match_", "camera.format",  "camera.width",  "camera.height",
      "camera.frame_rate", "camera.crop_",  "camera.buffers", "camera.timeout"};
  switch (kind) {
    case SourceKind::kSimulator:
      return simulator;
    case SourceKind::kFiles:
      return files;
    case SourceKind::kCamera:
      return camera;
  }
  return {};
}

// Of a camera that runs on.
void set_controls(const FrameSource& source, const Configuration& values) {
  const std::shared_ptr<CameraControls> controls = source.controls();
  if (controls == nullptr) return;
  for (const std::string& remark : controls->replace(values.camera.controls)) {
    log_warning("camera.controls: {}", remark);
  }
}

}  // namespace

std::string Daemon::reload() {
  service_.begin_reload(now().mono_us);
  reload_error_ = try_to_reload();
  report_state();
  service_.end_reload();
  return reload_error_;
}

// A reload is whole or does not happen: what changed is made first, then taken.
std::string Daemon::try_to_reload() {
  // True if a key of these sections changed.
  std::vector<std::string_view> changed;
  const auto touches = [&](std::initializer_list<std::string_view> sections) {
    return std::any_of(changed.begin(), changed.end(), [&](std::string_view key) {
      return std::any_of(sections.begin(), sections.end(),
                         [&](std::string_view section) { return key.starts_with(section); });
    });
  };
  try {
    Parts next;
    next.configuration = load_();
    changed = changed_keys(parts_.configuration.values, next.configuration.values);
    const Configuration& values = next.configuration.values;
    // How robots wear their markers is another matter.
    const bool other_markers =
        touches({"marker.diameter", "marker.bits", "marker.hamming", "marker.inner_ratio"});
    const bool new_source = touches({"source"}) || touches(source_sections(values.source));
    if (new_source) {
      next.source = make_source(next.configuration);
      next.source->follow(*parts_.source);
    }
    next.camera = make_camera(next.configuration, next.source ? *next.source : *parts_.source);
    const bool new_camera = !same_camera(next.camera, parts_.camera);
    const bool new_tracker = new_source || new_camera || other_markers || touches({"detector."});
    if (new_tracker) next.tracker.emplace(make_tracker(next.configuration, next.camera));
    if (touches({"lcm.", "camera.name"})) {
      next.broadcast.emplace(make_broadcast(next.configuration));
    }
    if (changed.empty() && !new_camera) {
      log_info("reloaded: nothing has changed");
      return {};
    }
    log_info("reloaded: {} changed", new_camera && changed.empty()
                                         ? std::string("the calibration")
                                         : fmt::format("{}", fmt::join(changed, ", ")));
    if (!next.source) next.source = std::move(parts_.source);
    if (!new_source && touches({"camera.controls"})) set_controls(*next.source, values);
    if (!next.tracker) next.tracker = std::move(parts_.tracker);
    if (!next.broadcast) next.broadcast = std::move(parts_.broadcast);
    start(std::move(next));
    return {};
  } catch (const std::exception& error) {
    log_error("{}; the configuration in use stays", error.what());
    return error.what();
  }
}

}  // namespace roundel
