#pragma once

#include "daemon/control/arena_service.hpp"
#include "daemon/control/event_feed.hpp"
#include "daemon/control/http_message.hpp"
#include "daemon/control/loop_commands.hpp"
#include "daemon/control/recording_service.hpp"
#include "daemon/control/shared_view.hpp"

namespace roundel {

// What the control socket offers (DESIGN.md section 6): from a request to an answer. All it knows
// are snapshots; what the frame loop has to do is posted to it, and waited for with patience's end.
class ControlApi {
 public:
  ControlApi(SharedView& view, ArenaService& arena, EventFeed& events, RecordingService& recordings,
             LoopCommands& loop)
      : view_(view), arena_(arena), events_(events), recordings_(recordings), loop_(loop) {}

  // Does not throw.
  HttpResponse handle(const HttpRequest& request);

 private:
  HttpResponse page(const HttpRequest& request);
  HttpResponse status(const HttpRequest& request);
  HttpResponse markers(const HttpRequest& request);
  HttpResponse events(const HttpRequest& request);
  HttpResponse picture(const HttpRequest& request);
  HttpResponse record(const HttpRequest& request);
  HttpResponse configuration(const HttpRequest& request);
  HttpResponse controls(const HttpRequest& request);
  HttpResponse set_controls(const HttpRequest& request);
  HttpResponse calibration(const HttpRequest& request);
  HttpResponse calibrate_arena(const HttpRequest& request);
  HttpResponse restore_arena(const HttpRequest& request);
  HttpResponse forget_arena(const HttpRequest& request);
  HttpResponse reload(const HttpRequest& request);
  HttpResponse calibration_answer(int status) const;
  std::shared_ptr<CameraControls> camera_controls();

  SharedView& view_;
  ArenaService& arena_;
  EventFeed& events_;
  RecordingService& recordings_;
  LoopCommands& loop_;

  struct Route;
  static std::span<const Route> routes();
};

}  // namespace roundel
