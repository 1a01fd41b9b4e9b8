#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "transport/lcm_link.hpp"
#include "transport/message_sender.hpp"

namespace roundel {

// Where encoded messages come from. Not thread-safe.
class MessageReceiver {
 public:
  // A message of a channel, and the wall clock when it arrived, microseconds.
  using Take = std::function<void(std::string_view channel, Bytes message, std::int64_t utime)>;

  MessageReceiver() = default;
  virtual ~MessageReceiver() = default;
  MessageReceiver(const MessageReceiver&) = delete;
  MessageReceiver& operator=(const MessageReceiver&) = delete;

  // Readable when receive() would find something; for poll(). -1: it can't receive.
  virtual int descriptor() const = 0;

  // Takes one message if one comes in time; it holds for the call. False if none came. Throws
  // std::runtime_error at the end of everything (of a log file).
  virtual bool receive(int timeout_ms, const Take& take) = 0;
};

// Receives the channels named at any LCM URL; multicast is joined at the network interface named,
// or, if that is empty, at the one that the routes name. Throws LcmUrlError, LcmUnavailable, or
// std::runtime_error if the link can't receive.
std::unique_ptr<MessageReceiver> open_receiver(const std::string& url,
                                               const std::vector<std::string>& channels,
                                               const std::string& interface_name = {});

// By LCM's library: for memq:// and log files.
std::unique_ptr<MessageReceiver> make_lcm_receiver(LcmLink link,
                                                   const std::vector<std::string>& channels);

}  // namespace roundel
