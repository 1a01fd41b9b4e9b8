#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>

#include "daemon/control/http_message.hpp"

namespace roundel {

// Server-sent events for everybody who listens: each is given the newest whenever it has taken the
// one before.
class EventFeed {
 public:
  bool has_listeners() const { return listeners_.load(std::memory_order_relaxed) > 0; }
  void offer(std::shared_ptr<const std::string> event);

  // One more listener. Must not outlive the feed.
  std::unique_ptr<HttpStream> listen();

 private:
  class Listener;

  std::mutex mutex_;
  std::shared_ptr<const std::string> newest_;
  std::uint64_t number_ = 0;  // of the newest; 0: there is none
  std::atomic<int> listeners_{0};
};

}  // namespace roundel
