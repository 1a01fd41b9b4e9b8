#include "config/web_address.hpp"

#include <arpa/inet.h>

#include <algorithm>
#include <array>
#include <charconv>

namespace roundel {

std::optional<WebAddress> parse_web_address(const std::string& text) {
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos || colon == 0) return std::nullopt;
  WebAddress address;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data() + colon + 1, end, address.port);
  if (error != std::errc() || stop != end) return std::nullopt;
  address.host = text.substr(0, colon);
  address.v6 = address.host.front() == '[' && address.host.back() == ']';
  if (address.v6) address.host = address.host.substr(1, address.host.size() - 2);
  std::array<unsigned char, sizeof(in6_addr)> bytes{};
  if (::inet_pton(address.v6 ? AF_INET6 : AF_INET, address.host.c_str(), bytes.data()) != 1) {
    return std::nullopt;
  }
  constexpr unsigned char kLoopbackNet = 127;
  const in6_addr loopback = IN6ADDR_LOOPBACK_INIT;
  address.loopback = address.v6 ? std::equal(bytes.begin(), bytes.end(), loopback.s6_addr)
                                : bytes[0] == kLoopbackNet;
  return address;
}

}  // namespace roundel
