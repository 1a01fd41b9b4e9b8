#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "transport/frame_assembler.hpp"
#include "transport/message_receiver.hpp"

namespace roundel {

// Receives what a Publisher sends. Not thread-safe. Whatever else arrives is counted and ignored.
class Subscriber {
 public:
  // At a URL, for multicast at a network interface (open_receiver()). Throws what that throws, and
  // std::invalid_argument for a channel prefix that LCM can't have.
  Subscriber(const std::string& url, const std::string& channel_prefix,
             const std::string& interface_name = {});
  // On a link that is shared with a publisher, within one process.
  Subscriber(LcmLink link, const std::string& channel_prefix);
  ~Subscriber();
  Subscriber(const Subscriber&) = delete;
  Subscriber& operator=(const Subscriber&) = delete;

  // Readable when next_frame() would find something; for poll().
  int descriptor() const;

  // The next complete frame, or nullptr after the time is over. It holds until the next call.
  const ReceivedFrame* next_frame(std::chrono::milliseconds timeout);

  // Wall clock of the machine when the last part of the frame just returned arrived, microseconds.
  std::int64_t received_utime() const;

  // The last status message that came while waiting for frames.
  const std::optional<status_t>& status() const;
  const ReceptionCounts& counts() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace roundel
