#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

namespace roundel {

// A URL that can't work, whatever the network does: "what is wrong; accepted: what would be right".
struct LcmUrlError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// An LCM URL, taken apart:
//   udpm://ADDRESS:PORT?ttl=N   UDP multicast; any part may be left out. With a machine's address,
//                               messages are sent to it alone (unicast, without ttl)
//   memq://                     within one process, for tests
//   file://PATH?mode=w          an LCM log file; mode=r reads one
struct LcmUrl {
  enum class Provider { kUdp, kMemory, kLogFile };

  Provider provider = Provider::kUdp;
  std::string address = "239.255.76.67";  // udpm: dotted IPv4
  std::uint16_t port = 7667;
  int ttl = 0;             // udpm: 0 stays on this machine
  int receive_buffer = 0;  // udpm: recv_buf_size, bytes; 0: what is usual
  bool writing = false;    // file: mode=w

  bool is_multicast() const;  // and not unicast, a file, ...
};

// Throws LcmUrlError for the address of a machine, which can only be sent to.
void require_group(const std::string& text, const LcmUrl& url);

// Throws LcmUrlError. LCM itself takes anything, warns, and falls back to something else.
LcmUrl parse_lcm_url(const std::string& url);

}  // namespace roundel
