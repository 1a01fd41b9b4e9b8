#pragma once

#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "config/configuration.hpp"
#include "daemon/control/arena_service.hpp"
#include "daemon/control/control_api.hpp"
#include "daemon/control/control_socket.hpp"
#include "daemon/control/event_feed.hpp"
#include "daemon/control/frame_snapshot.hpp"
#include "daemon/control/http_server.hpp"
#include "daemon/control/latest_value.hpp"
#include "daemon/control/loop_commands.hpp"
#include "daemon/control/recording_service.hpp"
#include "daemon/control/shared_view.hpp"
#include "daemon/control/wakeup.hpp"

namespace roundel {

// Everything that happens beside the frames: the control socket, the arena's calibration and watch.
// It works on a thread of its own (and one of the HTTP server's), both with less claim to the
// processor than the frame loop. The loop leaves snapshots here without waiting, and looks after
// commands between frames.
class ControlCenter {
 public:
  ControlCenter();
  ~ControlCenter();
  ControlCenter(const ControlCenter&) = delete;
  ControlCenter& operator=(const ControlCenter&) = delete;

  // The rest is for the frame loop's thread. None of it waits.

  // To poll for, and to be run when it is readable.
  LoopCommands& commands() { return commands_; }

  // The next snapshot, to be filled (it holds an old one), then offered.
  FrameSnapshot& next_snapshot() { return frames_.back(); }
  void offer_snapshot();
  // Whether the snapshot's picture is wanted.
  bool wants_picture() const { return view_.wants_picture(); }

  void offer(const status_t& status);

  // Serves on this socket, and for browsers, from now on. What goes wrong is told in the log.
  void serve(const ControlSettings& settings);

 private:
  void run();
  void take_news();
  void open_servers();
  void open_server();
  void open_web_server();
  template <typename Call>
  void each_server(Call call) {
    if (server_) call(*server_);
    if (web_server_) call(*web_server_);
  }

  Wakeup news_;
  LatestValue<FrameSnapshot> frames_;
  LatestValue<status_t> statuses_;
  LoopCommands commands_;
  SharedView view_;
  ArenaService arena_;
  EventFeed events_;
  RecordingService recordings_;
  ControlApi api_;

  std::mutex mutex_;  // of the three below
  std::optional<ControlSettings> wanted_;
  std::int64_t wanted_since_us_ = 0;
  bool ending_ = false;

  // Of the thread.
  ControlSettings served_{"", "", "", ""};
  std::optional<ControlSocket> socket_;
  std::optional<HttpServer> server_, web_server_;
  std::thread thread_;
};

}  // namespace roundel
