#include "daemon/control/web_socket.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace roundel {
namespace {

struct SocketAddress {
  sockaddr_storage storage{};
  socklen_t size = 0;
  sockaddr* generic() { return reinterpret_cast<sockaddr*>(&storage); }
};

SocketAddress socket_address(const WebAddress& address) {
  SocketAddress result;
  if (address.v6) {
    auto& v6 = reinterpret_cast<sockaddr_in6&>(result.storage);
    v6.sin6_family = AF_INET6;
    v6.sin6_port = htons(address.port);
    ::inet_pton(AF_INET6, address.host.c_str(), &v6.sin6_addr);
    result.size = sizeof v6;
  } else {
    auto& v4 = reinterpret_cast<sockaddr_in&>(result.storage);
    v4.sin_family = AF_INET;
    v4.sin_port = htons(address.port);
    ::inet_pton(AF_INET, address.host.c_str(), &v4.sin_addr);
    result.size = sizeof v4;
  }
  return result;
}

}  // namespace

WebSocket listen_for_web(const WebAddress& address) {
  constexpr int kBacklog = 64;
  SocketAddress at = socket_address(address);
  const auto fail = [&] {
    throw std::runtime_error(
        fmt::format("{}:{}: {}", address.host, address.port, std::strerror(errno)));
  };
  WebSocket result;
  result.descriptor =
      UniqueFd(::socket(at.storage.ss_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (!result.descriptor) fail();
  // A roundeld that starts again gets its port back at once.
  const int on = 1;
  ::setsockopt(result.descriptor.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  if (::bind(result.descriptor.get(), at.generic(), at.size) != 0 ||
      ::listen(result.descriptor.get(), kBacklog) != 0 ||
      ::getsockname(result.descriptor.get(), at.generic(), &at.size) != 0) {
    fail();
  }
  // The port lies at the same place in both families' addresses.
  const unsigned port = ntohs(reinterpret_cast<const sockaddr_in&>(at.storage).sin_port);
  result.url = fmt::format("http://{}{}{}:{}/", address.v6 ? "[" : "", address.host,
                           address.v6 ? "]" : "", port);
  return result;
}

}  // namespace roundel
