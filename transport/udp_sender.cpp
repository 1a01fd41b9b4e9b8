#include "transport/udp_sender.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <net/if.h>
#include <sys/socket.h>
#include <sys/uio.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "transport/lcm_datagram.hpp"
#include "transport/route.hpp"

namespace roundel {
namespace {

struct Header {
  std::uint32_t magic, sequence;  // big-endian
};

void set_option(int socket, int option, const void* value, std::size_t size) {
  if (::setsockopt(socket, IPPROTO_IP, option, value, static_cast<socklen_t>(size)) != 0) {
    throw LcmUnavailable(fmt::format("multicast can't be set up: {}", std::strerror(errno)));
  }
}

// 0: as the routes say, whatever that is now.
int interface_index(const LcmUrl& url, const std::string& wanted) {
  const std::string name = wanted.empty() ? find_route(url.address, url.port).interface : wanted;
  if (name.empty()) return 0;
  const unsigned index = ::if_nametoindex(name.c_str());
  if (index == 0) throw LcmUnavailable(fmt::format("there is no network interface {}", name));
  return static_cast<int>(index);
}

void set_up_multicast(int socket, const LcmUrl& url, const std::string& interface_name) {
  const auto hops = static_cast<unsigned char>(url.ttl);
  const unsigned char loop = 1;  // programs on this machine hear it too
  set_option(socket, IP_MULTICAST_TTL, &hops, sizeof hops);
  set_option(socket, IP_MULTICAST_LOOP, &loop, sizeof loop);
  if (interface_name.empty() && url.ttl > 0) return;
  // What leaves by a given interface needs no route.
  ip_mreqn group{};
  group.imr_ifindex = interface_index(url, interface_name);
  set_option(socket, IP_MULTICAST_IF, &group, sizeof group);
  if (url.ttl > 0) return;
  // Linux lets packets with TTL 0 out, unless somebody here has joined their group at the interface
  // that they leave by. What comes to this socket is left in its smallest buffer.
  const int smallest = 0;
  ::setsockopt(socket, SOL_SOCKET, SO_RCVBUF, &smallest, sizeof smallest);
  ::inet_pton(AF_INET, url.address.c_str(), &group.imr_multiaddr);
  set_option(socket, IP_ADD_MEMBERSHIP, &group, sizeof group);
}

}  // namespace

UdpSender::UdpSender(const LcmUrl& url, const std::string& interface_name) {
  if (interface_name.empty() || !url.is_multicast()) check_route(url);
  target_.sin_family = AF_INET;
  target_.sin_port = htons(url.port);
  ::inet_pton(AF_INET, url.address.c_str(), &target_.sin_addr);
  socket_ = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (socket_ < 0) throw LcmUnavailable(fmt::format("no socket: {}", std::strerror(errno)));
  try {
    if (url.is_multicast()) set_up_multicast(socket_, url, interface_name);
  } catch (...) {
    ::close(socket_);
    throw;
  }
}

UdpSender::~UdpSender() {
  ::close(socket_);
}

bool UdpSender::send(const char* channel, Bytes message) {
  const std::size_t channel_bytes = std::strlen(channel) + 1;
  if (channel_bytes + message.size() > kLcmMostBytes) return false;
  Header header{htonl(kLcmMagic), htonl(sequence_++)};
  // The kernel only reads from these, but its type is for both ways.
  std::array<iovec, 3> parts = {{{&header, sizeof header},
                                 {const_cast<char*>(channel), channel_bytes},
                                 {const_cast<std::uint8_t*>(message.data()), message.size()}}};
  msghdr datagram{};
  datagram.msg_name = &target_;
  datagram.msg_namelen = sizeof target_;
  datagram.msg_iov = parts.data();
  datagram.msg_iovlen = parts.size();
  return ::sendmsg(socket_, &datagram, MSG_DONTWAIT | MSG_NOSIGNAL) >= 0;
}

}  // namespace roundel
