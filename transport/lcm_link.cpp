#include "transport/lcm_link.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "transport/lcm_url.hpp"

namespace roundel {
namespace {

// The kernel looks a route up when a datagram socket is connected; nothing is sent.
int connect_error(const std::string& group, std::uint16_t port) {
  const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (socket < 0) return errno;
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  ::inet_pton(AF_INET, group.c_str(), &address.sin_addr);
  const bool connected =
      ::connect(socket, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0;
  const int error = connected ? 0 : errno;
  ::close(socket);
  return error;
}

void check_route(const LcmUrl& url) {
  const int error = connect_error(url.address, url.port);
  if (error == 0) return;
  throw LcmUnavailable(
      fmt::format("no route to the multicast group {} ({}); one is made by: ip route add "
                  "239.0.0.0/8 dev INTERFACE (lo for this machine alone)",
                  url.address, std::strerror(error)));
}

}  // namespace

LcmLink open_lcm(const std::string& url, LcmUse use) {
  const LcmUrl parsed = parse_lcm_url(url);
  if (parsed.provider == LcmUrl::Provider::kLogFile && parsed.writing != (use == LcmUse::kSend)) {
    throw LcmUrlError(fmt::format(
        "\"{}\": {}", url,
        use == LcmUse::kSend ? "to write a log file, add ?mode=w" : "mode=w can't be listened to"));
  }
  // Asked here, because lcm_create() reports a missing route by several lines on standard error.
  if (parsed.provider == LcmUrl::Provider::kUdpMulticast) check_route(parsed);
  LcmLink link(::lcm_create(url.c_str()), [](lcm_t* lcm) {
    if (lcm != nullptr) ::lcm_destroy(lcm);
  });
  if (!link) throw LcmUnavailable(fmt::format("LCM can't open \"{}\"", url));
  return link;
}

}  // namespace roundel
