#include "transport/lcm_url.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>

#include <charconv>
#include <optional>
#include <string_view>

namespace roundel {
namespace {

constexpr std::string_view kAccepted =
    "accepted: udpm://ADDRESS:PORT?ttl=N with a multicast address (224.0.0.0 to 239.255.255.255), "
    "udpm://ADDRESS:PORT with a machine's address, memq://, file://PATH?mode=w";

[[noreturn]] void fail(const std::string& url, std::string_view what) {
  throw LcmUrlError(fmt::format("\"{}\" is no usable LCM URL: {}; {}", url, what, kAccepted));
}

std::optional<int> whole_number(std::string_view text, int max) {
  int value = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || stop != text.data() + text.size() || value < 0 || value > max) {
    return std::nullopt;
  }
  return value;
}

// Cuts `text` at the first `separator` and returns what is before it.
std::string_view take(std::string_view& text, std::string_view separators) {
  const std::size_t at = text.find_first_of(separators);
  const std::string_view before = text.substr(0, at);
  text = at == std::string_view::npos ? std::string_view() : text.substr(at + 1);
  return before;
}

void read_network(const std::string& url, std::string_view network, LcmUrl& parsed) {
  constexpr int kMaxPort = 65535;
  if (network.empty()) return;
  const std::string address(take(network, ":"));
  in_addr binary{};
  if (::inet_pton(AF_INET, address.c_str(), &binary) != 1) {
    fail(url, fmt::format("\"{}\" is not an IPv4 address", address));
  }
  if (binary.s_addr == INADDR_ANY || binary.s_addr == INADDR_BROADCAST) {
    fail(url, fmt::format("{} is nobody's address", address));
  }
  parsed.address = address;
  if (network.empty()) return;
  const std::optional<int> port = whole_number(network, kMaxPort);
  if (!port || *port == 0) fail(url, fmt::format("\"{}\" is not a port", network));
  parsed.port = static_cast<std::uint16_t>(*port);
}

void read_option(const std::string& url, std::string_view name, std::string_view value,
                 LcmUrl& parsed) {
  constexpr int kMaxTtl = 255, kMaxBuffer = 1 << 30;
  using enum LcmUrl::Provider;
  if (parsed.provider == kUdp && name == "ttl") {
    const std::optional<int> ttl = whole_number(value, kMaxTtl);
    if (!ttl) fail(url, "ttl must be 0 to 255");
    parsed.ttl = *ttl;
  } else if (parsed.provider == kUdp && name == "recv_buf_size") {
    const std::optional<int> bytes = whole_number(value, kMaxBuffer);
    if (!bytes) fail(url, "recv_buf_size must be a number of bytes");
    parsed.receive_buffer = *bytes;
  } else if (parsed.provider == kLogFile && name == "mode") {
    if (value != "w" && value != "r") fail(url, "mode must be r or w");
    parsed.writing = value == "w";
  } else if (parsed.provider == kLogFile && (name == "speed" || name == "start_timestamp")) {
    // For reading; LCM takes any number.
  } else {
    fail(url, fmt::format("unknown option \"{}\"", name));
  }
}

}  // namespace

bool LcmUrl::is_multicast() const {
  in_addr binary{};
  return provider == Provider::kUdp && ::inet_pton(AF_INET, address.c_str(), &binary) == 1 &&
         IN_MULTICAST(ntohl(binary.s_addr));
}

void require_group(const std::string& text, const LcmUrl& url) {
  if (url.is_multicast()) return;
  throw LcmUrlError(
      fmt::format("\"{}\" is for sending to one machine; that machine listens at any multicast URL "
                  "with the same "
                  "port, as in udpm://239.255.76.67:{}",
                  text, url.port));
}

LcmUrl parse_lcm_url(const std::string& url) {
  LcmUrl parsed;
  std::string_view rest = url;
  if (url.find('\0') != std::string::npos) fail(url, "it has a zero byte in it");
  if (rest.starts_with("udpm://")) {
    parsed.provider = LcmUrl::Provider::kUdp;
  } else if (rest.starts_with("memq://")) {
    parsed.provider = LcmUrl::Provider::kMemory;
  } else if (rest.starts_with("file://")) {
    parsed.provider = LcmUrl::Provider::kLogFile;
  } else {
    fail(url, "unknown kind");
  }
  rest.remove_prefix(rest.find("://") + 3);
  const std::string_view target = take(rest, "?");
  if (parsed.provider == LcmUrl::Provider::kUdp) read_network(url, target, parsed);
  if (parsed.provider == LcmUrl::Provider::kLogFile && target.empty()) fail(url, "no path");
  while (!rest.empty()) {
    std::string_view value = take(rest, "&,");
    const std::string_view name = take(value, "=");
    if (!name.empty()) read_option(url, name, value, parsed);
  }
  return parsed;
}

}  // namespace roundel
