#pragma once

#include <cstdint>
#include <string>

namespace roundel {

// The way that packets to an IPv4 address take, by the kernel's routes as they are now.
struct Route {
  int error = 0;          // errno; 0: there is one
  std::string interface;  // as in eth0; empty: unknown
  std::string address;    // that they come from, dotted; empty: none but this machine's own
};

// Sends nothing.
Route find_route(const std::string& address, std::uint16_t port);

}  // namespace roundel
