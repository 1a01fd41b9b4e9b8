#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "transport/lcm_link.hpp"

namespace roundel {

using Bytes = std::span<const std::uint8_t>;

// Where encoded messages go. Not thread-safe. send() neither allocates nor waits for a receiver.
class MessageSender {
 public:
  MessageSender() = default;
  virtual ~MessageSender() = default;
  MessageSender(const MessageSender&) = delete;
  MessageSender& operator=(const MessageSender&) = delete;

  // False if it could not be given to the network as a whole.
  virtual bool send(const char* channel, Bytes message) = 0;
};

// By LCM's library: for memq:// and log files.
class LcmSender final : public MessageSender {
 public:
  explicit LcmSender(LcmLink link) : link_(std::move(link)) {}
  bool send(const char* channel, Bytes message) override;

 private:
  LcmLink link_;
};

// The sender for any LCM URL; multicast leaves by the network interface named, or, if that is
// empty, by the one that the machine's routes name. Throws LcmUrlError, or LcmUnavailable (no
// route, no such interface).
std::unique_ptr<MessageSender> open_sender(const std::string& url,
                                           const std::string& interface_name = {});

}  // namespace roundel
