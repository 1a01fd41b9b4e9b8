#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace roundel {

// Where the web page is served, "127.0.0.1:8080" or "[::1]:8080": numbers, not names.
struct WebAddress {
  std::string host;  // without brackets
  std::uint16_t port = 0;
  bool v6 = false;
  bool loopback = false;  // only this machine gets there
};

// Nothing if the text is of another form. Port 0: whichever is free.
std::optional<WebAddress> parse_web_address(const std::string& text);

// Fewer characters of a token can be guessed.
inline constexpr std::size_t kLeastToken = 16;

}  // namespace roundel
