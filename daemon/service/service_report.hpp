#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <memory>
#include <string_view>

#include "daemon/service/service_link.hpp"

namespace roundel {

// What the service manager knows of roundeld: whether it is ready, what it is doing, and that it
// lives. Only the thread that carries frames calls it, so that a sign of life means that frames are
// being carried. Does not allocate once a status has been told.
class ServiceReport {
 public:
  explicit ServiceReport(std::unique_ptr<ServiceLink> link);

  // Once; later calls do nothing.
  void ready();
  bool is_ready() const { return ready_; }

  // One line for people, told if it differs from the one before. Line breaks become spaces.
  void status(std::string_view text);

  // Between these two a new configuration takes effect, or does not.
  void begin_reload(std::int64_t now_us);
  void end_reload();

  void stopping();

  // The loop has made progress, or waits as it should. Cheap enough for every frame: the manager
  // hears of it four times in its watchdog's period. Times are CLOCK_MONOTONIC.
  void alive(std::int64_t now_ns);
  // How long the loop may sleep before it calls alive() again; -1: for ever.
  int sleep_ms(std::int64_t now_ns) const;

 private:
  std::unique_ptr<ServiceLink> link_;
  std::int64_t period_ns_ = 0;  // from one sign of life to the next; 0: none are wanted
  std::int64_t due_ns_ = 0;     // of the next
  bool ready_ = false;
  fmt::memory_buffer told_, next_;  // "STATUS=...", with a final zero
};

}  // namespace roundel
