#pragma once

#include <netinet/in.h>

#include <string>

#include "transport/lcm_url.hpp"
#include "transport/message_sender.hpp"

namespace roundel {

// Sends what LCM's own library would send, one datagram a message, but never waits, receives
// nothing, can name the interface, and can send to one machine alone (unicast), none of which the
// library can.
class UdpSender final : public MessageSender {
 public:
  // The interface is for multicast; unicast goes where the routes say. Throws LcmUnavailable.
  UdpSender(const LcmUrl& url, const std::string& interface_name);
  ~UdpSender() override;

  // Messages beyond 65 kB (LCM sends them as fragments) are refused: nobody makes such.
  bool send(const char* channel, Bytes message) override;

 private:
  int socket_ = -1;  // owns
  sockaddr_in target_{};
  std::uint32_t sequence_ = 0;
};

}  // namespace roundel
