#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "transport/message_receiver.hpp"

namespace roundel {

// Receives messages of LCM that came in one datagram each, as UdpSender and LCM's library send
// them. The library's own receiver (1.3.1, Debian 12) can be made to crash by anybody who sends it
// two crafted fragments; this one knows no fragments, and whatever else arrives is passed over. It
// hears the group, and what is sent to this machine alone.
class UdpReceiver final : public MessageReceiver {
 public:
  // Throws LcmUrlError for the address of a machine, LcmUnavailable.
  UdpReceiver(const std::string& url, std::vector<std::string> channels,
              const std::string& interface_name);
  ~UdpReceiver() override;

  int descriptor() const override { return socket_; }
  bool receive(int timeout_ms, const Take& take) override;

 private:
  std::int64_t read_datagram();  // its bytes; -1: there is none
  bool hand_over(std::size_t size, const Take& take) const;

  std::vector<std::string> channels_;
  int socket_ = -1;                     // owns
  std::vector<std::uint8_t> datagram_;  // room for the largest
  std::int64_t arrived_utime_ = 0;
};

}  // namespace roundel
