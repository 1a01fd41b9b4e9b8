#include "daemon/control/state_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "calibration/arena_file.hpp"
#include "daemon/json_fields.hpp"
#include "daemon/json_frame.hpp"

namespace roundel {
namespace {

using Json = nlohmann::ordered_json;

template <std::size_t N>
const char* name_of(const std::array<const char*, N>& names, int code) {
  const bool known = code >= 0 && static_cast<std::size_t>(code) < N;
  if (!known) return "unknown";
  // cppcheck-suppress CastIntegerToAddressAtReturn  ; the elements are pointers
  return names[static_cast<std::size_t>(code)];
}

constexpr std::array kCameraStates = {"starting", "streaming", "lost", "ended"};
constexpr std::array kCalibrationStates = {"none", "valid", "other_resolution"};
constexpr std::array kArenaStates = {"none", "valid", "other_camera", "moved"};
constexpr std::array kClockStates = {"unknown", "synchronised", "free_running"};
constexpr std::array kStampSources = {"unknown", "middle_of_exposure", "start_of_frame",
                                      "end_of_frame", "arrival"};
constexpr std::array kRunStates = {"idle", "running", "done", "failed"};

Json latency_json(const latency_t& latency) {
  return {{"p50", latency.p50}, {"p90", latency.p90}, {"p99", latency.p99}, {"max", latency.max}};
}

const char* mode_name(ArenaMode mode) {
  return mode == ArenaMode::k2D ? "2d" : "3d";
}

Json arena_json(const ArenaCalibration& calibration) {
  Json references = Json::array();
  for (const ArenaReference& r : calibration.references) {
    references.push_back({{"id", r.id},
                          {"x", r.place.x()},
                          {"y", r.place.y()},
                          {"u", r.pixel.x()},
                          {"v", r.pixel.y()},
                          {"residual_mm", 1000 * r.residual.norm()},
                          {"residual", {r.residual.x(), r.residual.y()}}});
  }
  Json sides = Json::array();
  for (const double error : calibration.side_errors) sides.push_back(1000 * error);
  return {{"width", calibration.request.width_m},
          {"height", calibration.request.height_m},
          {"origin", origin_name(calibration.request.origin)},
          {"date", calibration.date},
          {"version", calibration.version},
          {"frames", calibration.frames},
          {"certainty_mm", 1000 * calibration.certainty_m},
          {"size_by_markers", calibration.size_by_markers},
          {"side_errors_mm", sides},
          {"fixed_markers", references},
          {"camera",
           {{"identity", calibration.camera.identity},
            {"width", calibration.camera.intrinsics.width},
            {"height", calibration.camera.intrinsics.height},
            {"crop", calibration.camera.crop}}},
          {"arena_in_camera",
           {{"position", vector_json(calibration.arena_in_camera.position)},
            {"orientation", quaternion_json(calibration.arena_in_camera.orientation)}}}};
}

void refuse_unknown(const Json& json, std::initializer_list<const char*> known) {
  for (const auto& item : json.items()) {
    const std::string& key = item.key();
    if (std::none_of(known.begin(), known.end(), [&](const char* k) { return key == k; })) {
      throw std::runtime_error(fmt::format("there is no field {}", key));
    }
  }
}

}  // namespace

Json status_json(const status_t& status, const TrackingContext* context,
                 const std::string& watch_text) {
  std::string problem = context == nullptr ? "" : context->problem;
  Json arena = {{"state", name_of(kArenaStates, status.arena_state)}};
  if (context != nullptr) arena["mode"] = mode_name(context->mode);
  if (!problem.empty()) arena["problem"] = problem;
  if (context != nullptr && context->calibration) arena["date"] = context->calibration->date;
  if (!watch_text.empty()) arena["watch"] = watch_text;
  return {{"version", status.version},
          {"uptime_s", static_cast<double>(status.uptime) / 1e6},
          {"session", status.session},
          {"camera",
           {{"name", status.camera},
            {"source", status.source},
            {"state", name_of(kCameraStates, status.camera_state)},
            {"calibration", name_of(kCalibrationStates, status.calibration_state)},
            {"width", status.width},
            {"height", status.height},
            {"simulated", status.simulated != 0}}},
          {"frames", status.frames},
          {"frame_rate", status.frame_rate},
          {"dropped", status.dropped},
          {"drops",
           {{"lost", status.dropped_lost},
            {"newer", status.dropped_newer},
            {"damaged", status.dropped_damaged},
            {"stale", status.dropped_stale}}},
          {"unsent", status.unsent},
          {"markers", status.markers},
          {"latency_us",
           {{"arrival", latency_json(status.arrival)},
            {"reading", latency_json(status.reading)},
            {"tracking", latency_json(status.tracking)},
            {"following", latency_json(status.following)},
            {"searching", latency_json(status.searching)},
            {"identifying", latency_json(status.identifying)},
            {"publishing", latency_json(status.publishing)},
            {"handling", latency_json(status.handling)},
            {"total", latency_json(status.total)}}},
          {"stamp_source", name_of(kStampSources, status.stamp_source)},
          {"clock", name_of(kClockStates, status.clock_state)},
          {"arena", arena},
          {"lcm", {{"url", status.url}}}};
}

Json markers_json(const FrameSnapshot& frame) {
  const FrameInformation& information = frame.information;
  Json json = frame_json({frame.context->camera_name, information.frame,
                          information.captured.wall_us, information.tracking_us},
                         frame.markers, frame.arena);
  json["session"] = information.session;
  json["arena_state"] = name_of(kArenaStates, static_cast<int>(information.arena));
  return json;
}

Json calibration_json(const TrackingContext* context, const CalibrationProgress& progress,
                      const std::string& watch_text) {
  Json run = {{"state", name_of(kRunStates, static_cast<int>(progress.state))},
              {"frames", progress.frames},
              {"markers", progress.markers},
              {"elapsed_s", progress.elapsed_s},
              {"text", progress.text}};
  if (progress.certainty_m) run["certainty_mm"] = 1000 * *progress.certainty_m;
  Json json = {{"run", run}, {"arena", nullptr}};
  if (context == nullptr) return json;
  json["file"] = context->arena_file;
  json["in_use"] = context->arena_in_use();
  if (!context->problem.empty()) json["problem"] = context->problem;
  if (context->calibration) json["arena"] = arena_json(*context->calibration);
  if (!watch_text.empty()) json["watch"] = watch_text;
  return json;
}

ArenaRequest arena_request_from_json(const Json& json) {
  constexpr std::int64_t kMaxId = 65535;
  constexpr std::size_t kMaxList = 200;
  if (!json.is_object()) throw std::runtime_error("the request must be a JSON object");
  refuse_unknown(json, {"width", "height", "origin", "ids", "anchors", "corner_height",
                        "corner_diameter", "certainty", "time_limit", "tolerance"});
  ArenaRequest request;
  request.width_m = number_field(json, "width");
  request.height_m = number_field(json, "height");
  if (has_field(json, "origin")) {
    const auto origin = origin_of(string_field(json, "origin"));
    if (!origin) {
      throw std::runtime_error("origin is not bottom-left, bottom-right, top-right or top-left");
    }
    request.origin = *origin;
  }
  if (has_field(json, "ids")) {
    const Json& list = array_field(json, "ids");
    if (list.size() > kMaxList) throw std::runtime_error("ids has too many elements");
    for (const Json& id : list) {
      request.ids.push_back(static_cast<int>(integer_field(Json{{"ids", id}}, "ids", 1, kMaxId)));
    }
  }
  if (has_field(json, "anchors")) {
    const Json& list = array_field(json, "anchors");
    if (list.size() > kMaxList) throw std::runtime_error("anchors has too many elements");
    for (const Json& anchor : list) {
      refuse_unknown(anchor, {"id", "x", "y"});
      request.anchors.push_back({static_cast<int>(integer_field(anchor, "id", 1, kMaxId)),
                                 number_field(anchor, "x"), number_field(anchor, "y")});
    }
  }
  const auto optional = [&](const char* key, double& value) {
    if (has_field(json, key)) value = number_field(json, key);
  };
  optional("corner_height", request.corner_height_m);
  optional("corner_diameter", request.corner_diameter_m);
  optional("certainty", request.certainty_m);
  optional("time_limit", request.time_limit_s);
  optional("tolerance", request.tolerance_m);
  return request;
}

}  // namespace roundel
