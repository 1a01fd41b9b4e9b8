#include "daemon/control/control_api.hpp"

#include <algorithm>
#include <array>
#include <exception>
#include <future>
#include <nlohmann/json.hpp>

#include "config/writer.hpp"
#include "daemon/control/ask_loop.hpp"
#include "daemon/control/controls_json.hpp"
#include "daemon/control/snapshot_picture.hpp"
#include "daemon/control/state_json.hpp"
#include "daemon/control/web_page.hpp"

namespace roundel {
namespace {

using Json = nlohmann::ordered_json;
using namespace std::chrono_literals;

constexpr auto kPicturePatience = 3s;  // with the camera

enum Status {
  kOk = 200,
  kAccepted = 202,
  kBad = 400,
  kUnknown = 404,
  kMethod = 405,
  kConflict = 409,
  kUnfit = 422,
  kUnavailable = 503
};

HttpResponse json_answer(int status, const Json& json) {
  return {status, "application/json",
          json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n", "", nullptr};
}

HttpResponse error_answer(int status, const std::string& what) {
  return json_answer(status, {{"error", what}});
}

std::pair<PictureFormat, const char*> picture_kind(const std::string& path) {
  if (path.ends_with(".png")) return {PictureFormat::kPng, "image/png"};
  if (path.ends_with(".pgm")) return {PictureFormat::kPgm, "image/x-portable-graymap"};
  return {PictureFormat::kJpeg, "image/jpeg"};
}

}  // namespace

struct ControlApi::Route {
  const char* path;
  const char* method;
  HttpResponse (ControlApi::*answer)(const HttpRequest&);
};

std::span<const ControlApi::Route> ControlApi::routes() {
  static constexpr std::array kRoutes = {
      Route{"/", "GET", &ControlApi::page},
      Route{"/v1/status", "GET", &ControlApi::status},
      Route{"/v1/markers", "GET", &ControlApi::markers},
      Route{"/v1/events", "GET", &ControlApi::events},
      Route{"/v1/frame.jpg", "GET", &ControlApi::picture},
      Route{"/v1/frame.png", "GET", &ControlApi::picture},
      Route{"/v1/frame.pgm", "GET", &ControlApi::picture},
      Route{"/v1/recording", "POST", &ControlApi::record},
      Route{"/v1/configuration", "GET", &ControlApi::configuration},
      Route{"/v1/controls", "GET", &ControlApi::controls},
      Route{"/v1/controls", "PUT", &ControlApi::set_controls},
      Route{"/v1/calibration", "GET", &ControlApi::calibration},
      Route{"/v1/calibration/arena", "POST", &ControlApi::calibrate_arena},
      Route{"/v1/calibration/arena", "DELETE", &ControlApi::forget_arena},
      Route{"/v1/calibration/restore", "POST", &ControlApi::restore_arena},
      Route{"/v1/reload", "POST", &ControlApi::reload},
  };
  return kRoutes;
}

HttpResponse ControlApi::handle(const HttpRequest& request) {
  std::string allowed;
  for (const Route& route : routes()) {
    if (request.path != route.path) continue;
    if (request.method != route.method) {
      allowed += (allowed.empty() ? "" : ", ") + std::string(route.method);
      continue;
    }
    try {
      return (this->*route.answer)(request);
    } catch (const std::future_error&) {
      return error_answer(kUnavailable, "roundeld is ending");
    } catch (const std::exception& error) {
      return error_answer(kUnavailable, error.what());
    }
  }
  if (allowed.empty()) return error_answer(kUnknown, "there is no " + request.path);
  HttpResponse response = error_answer(kMethod, request.path + " is for " + allowed);
  response.allow = allowed;
  return response;
}

HttpResponse ControlApi::page(const HttpRequest& /*request*/) {
  return web_page();
}

HttpResponse ControlApi::status(const HttpRequest& /*request*/) {
  const auto frame = view_.frame();
  status_t status = view_.status();
  // The newest frame knows better than the status of the last second.
  if (frame) status.arena_state = to_message(frame->information).arena_state;
  return json_answer(
      kOk, status_json(status, frame ? frame->context.get() : nullptr, arena_.watch_text()));
}

HttpResponse ControlApi::markers(const HttpRequest& /*request*/) {
  const auto frame = view_.frame();
  if (!frame) return error_answer(kUnavailable, "no frame has come from the camera yet");
  return json_answer(kOk, markers_json(*frame));
}

HttpResponse ControlApi::events(const HttpRequest& /*request*/) {
  HttpResponse response;
  response.type = "text/event-stream";
  response.stream = events_.listen();
  return response;
}

HttpResponse ControlApi::picture(const HttpRequest& request) {
  // A camera that is gone keeps nobody waiting: meanwhile no other client would be served.
  const bool gone = view_.status().camera_state == header_t::CAMERA_LOST;
  const auto frame = gone ? nullptr : view_.next_picture(kPicturePatience);
  if (!frame) return error_answer(kUnavailable, "no frame comes from the camera");
  HttpResponse response;
  const auto [format, type] = picture_kind(request.path);
  response.type = type;
  response.body = encode_picture(*frame, format, !request.plain_picture);
  return response;
}

HttpResponse ControlApi::record(const HttpRequest& request) {
  const auto frame = view_.frame();
  if (!frame) return error_answer(kUnavailable, "no frame has come from the camera yet");
  HttpResponse response;
  response.type = "application/x-roundel-recording";
  try {
    response.stream = recordings_.start(*frame, view_.status().frame_rate, !request.keep_tracks);
  } catch (const std::future_error&) {  // a logic_error too
    throw;
  } catch (const std::logic_error& error) {
    return error_answer(kConflict, error.what());
  }
  return response;
}

HttpResponse ControlApi::configuration(const HttpRequest& /*request*/) {
  const Configuration values =
      ask_loop(loop_, [](LoopControl& control) { return control.configuration(); });
  return json_answer(kOk, {{"yaml", configuration_yaml(values)}});
}

std::shared_ptr<CameraControls> ControlApi::camera_controls() {
  return ask_loop(loop_, [](LoopControl& control) { return control.camera_controls(); });
}

HttpResponse ControlApi::controls(const HttpRequest& /*request*/) {
  Json list = Json::array();
  if (const auto controls = camera_controls()) {
    for (const Control& control : controls->list()) list.push_back(control_json(control));
  }
  return json_answer(kOk, {{"controls", std::move(list)}});
}

// Answers with the controls that were set, as they were read back.
HttpResponse ControlApi::set_controls(const HttpRequest& request) {
  const auto controls = camera_controls();
  if (!controls) return error_answer(kConflict, "the source of frames has no controls");
  try {
    Json list = Json::array();
    for (const auto& [name, value] : control_values_from_json(Json::parse(request.body))) {
      list.push_back(control_json(controls->set(name, value)));
    }
    return json_answer(kOk, {{"controls", std::move(list)}});
  } catch (const Json::parse_error&) {
    return error_answer(kBad, "the request is not valid JSON");
  } catch (const CameraError& error) {
    return error_answer(kConflict, error.what());
  } catch (const std::exception& error) {
    return error_answer(kBad, error.what());
  }
}

HttpResponse ControlApi::calibration_answer(int status) const {
  const auto frame = view_.frame();
  return json_answer(status, calibration_json(frame ? frame->context.get() : nullptr,
                                              arena_.progress(), arena_.watch_text()));
}

HttpResponse ControlApi::calibration(const HttpRequest& /*request*/) {
  return calibration_answer(kOk);
}

HttpResponse ControlApi::calibrate_arena(const HttpRequest& request) {
  try {
    arena_.start(arena_request_from_json(Json::parse(request.body)));
  } catch (const Json::parse_error&) {
    return error_answer(kBad, "the request is not valid JSON");
  } catch (const std::invalid_argument& error) {
    return error_answer(kBad, error.what());
  } catch (const std::runtime_error& error) {
    return error_answer(kConflict, error.what());
  }
  return calibration_answer(kAccepted);
}

HttpResponse ControlApi::restore_arena(const HttpRequest& /*request*/) {
  try {
    return json_answer(kOk, {{"date", arena_.restore().date}});
  } catch (const std::runtime_error& error) {
    return error_answer(kConflict, error.what());
  }
}

HttpResponse ControlApi::forget_arena(const HttpRequest& /*request*/) {
  arena_.cancel();
  arena_.forget();
  return json_answer(kOk, Json::object());
}

HttpResponse ControlApi::reload(const HttpRequest& /*request*/) {
  const std::string error = ask_loop(loop_, [](LoopControl& control) { return control.reload(); });
  return error.empty() ? json_answer(kOk, Json::object()) : error_answer(kUnfit, error);
}

}  // namespace roundel
