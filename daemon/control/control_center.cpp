#include "daemon/control/control_center.hpp"

#include <poll.h>
#include <sys/resource.h>

#include <algorithm>
#include <utility>

#include "config/web_address.hpp"
#include "daemon/control/state_json.hpp"
#include "daemon/control/web_gate.hpp"
#include "daemon/control/web_socket.hpp"
#include "daemon/json_frame.hpp"
#include "daemon/log.hpp"
#include "transport/clock.hpp"

namespace roundel {
namespace {

constexpr int kTickMs = 250;
constexpr std::int64_t kOverduePeriodUs = 1'000'000;
// Whoever has asked for the reload that moves the server gets the answer from the old one.
constexpr std::int64_t kFarewellUs = 250'000;
constexpr int kNiceness = 10;

}  // namespace

ControlCenter::ControlCenter()
    : arena_(commands_),
      recordings_(commands_),
      api_(view_, arena_, events_, recordings_, commands_),
      thread_([this] { run(); }) {}

ControlCenter::~ControlCenter() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  // Whoever waits for the loop or for a picture would wait in vain.
  commands_.drop_all();
  view_.close();
  news_.wake();
  thread_.join();
}

void ControlCenter::offer_snapshot() {
  frames_.publish();
  news_.wake();
}

void ControlCenter::offer(const status_t& status) {
  statuses_.back() = status;
  statuses_.publish();
  news_.wake();
}

void ControlCenter::serve(const ControlSettings& settings) {
  {
    const std::lock_guard lock(mutex_);
    wanted_ = settings;
    wanted_since_us_ = now().mono_us;
  }
  news_.wake();
}

void ControlCenter::run() {
  // In Linux this is the calling thread's; threads that it starts inherit it.
  ::setpriority(PRIO_PROCESS, 0, kNiceness);
  std::int64_t overdue_us = 0;
  for (;;) {
    pollfd descriptor = {news_.descriptor(), POLLIN, 0};
    ::poll(&descriptor, 1, kTickMs);
    news_.clear();
    {
      const std::lock_guard lock(mutex_);
      if (ending_) break;
    }
    take_news();
    const std::int64_t now_us = now().mono_us;
    arena_.on_tick(now_us);
    recordings_.on_tick();
    open_servers();
    if (now_us >= overdue_us) {
      each_server([](HttpServer& server) { server.end_overdue(); });
      overdue_us = now_us + kOverduePeriodUs;
    }
  }
  web_server_.reset();
  server_.reset();
  socket_.reset();
}

void ControlCenter::take_news() {
  if (const status_t* status = statuses_.take()) view_.show(*status);
  const FrameSnapshot* const frame = frames_.take();
  if (frame == nullptr) return;
  auto shown = std::make_shared<FrameSnapshot>();
  shown->information = frame->information;
  shown->markers = frame->markers;
  shown->arena = frame->arena;
  shown->context = frame->context;
  shown->has_picture = frame->has_picture;
  // Slots keep the memory of old pictures.
  if (frame->has_picture) shown->picture = frame->picture;
  arena_.on_frame(*shown);
  if (events_.has_listeners()) {
    events_.offer(std::make_shared<const std::string>(
        "event: frame\ndata: " + json_line(markers_json(*shown)) + "\n"));
  }
  view_.show(std::move(shown));
  each_server([](HttpServer& server) { server.wake_streams(); });
}

void ControlCenter::open_servers() {
  std::optional<ControlSettings> wanted;
  {
    const std::lock_guard lock(mutex_);
    const bool serves = server_ || web_server_;
    if (serves && now().mono_us - wanted_since_us_ < kFarewellUs) return;
    wanted.swap(wanted_);
  }
  if (!wanted) return;
  const ControlSettings before = std::exchange(served_, *wanted);
  if (served_.socket != before.socket || served_.group != before.group) open_server();
  if (served_.web != before.web || served_.token != before.token) open_web_server();
}

void ControlCenter::open_server() {
  server_.reset();
  socket_.reset();
  if (served_.socket.empty()) return;
  try {
    socket_.emplace(served_.socket, served_.group);
    if (!socket_->remark().empty()) {
      log_warning("control.group: {}: {}", served_.socket, socket_->remark());
    }
    server_.emplace(
        socket_->take_descriptor(),
        [this](const HttpRequest& request) { return api_.handle(request); }, HttpLimits{});
  } catch (const std::runtime_error& error) {
    socket_.reset();
    log_warning("control.socket: {}; roundel status and the like can't reach this roundeld",
                error.what());
  }
}

void ControlCenter::open_web_server() {
  web_server_.reset();
  const auto address = parse_web_address(served_.web);
  if (!address) return;
  try {
    WebSocket socket = listen_for_web(*address);
    const WebGate gate([this](const HttpRequest& request) { return api_.handle(request); },
                       served_.token);
    HttpLimits limits;
    limits.connections = 64;
    web_server_.emplace(
        std::move(socket.descriptor),
        [gate](const HttpRequest& request) { return gate.handle(request); }, limits);
    log_info("web page: {}{}", socket.url, served_.token.empty() ? "" : "?token=...");
  } catch (const std::runtime_error& error) {
    log_warning("control.web: {}; there is no web page", error.what());
  }
}

}  // namespace roundel
