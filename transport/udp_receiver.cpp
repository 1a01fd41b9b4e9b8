#include "transport/udp_receiver.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <net/if.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>

#include "transport/clock.hpp"
#include "transport/lcm_datagram.hpp"
#include "transport/lcm_url.hpp"

namespace roundel {
namespace {

constexpr std::size_t kMostBytes = 65536;
// Some hundred frames of 100 markers, if the kernel allows so much (net.core.rmem_max).
constexpr int kUsualBuffer = 4 << 20;
constexpr int kMostPassedOver = 1000;

[[noreturn]] void fail(const LcmUrl& url, const char* what) {
  throw LcmUnavailable(fmt::format("{}:{} can't be listened to: {}: {}", url.address, url.port,
                                   what, std::strerror(errno)));
}

template <typename Value>
bool set(int socket, int level, int option, const Value& value) {
  return ::setsockopt(socket, level, option, &value, sizeof value) == 0;
}

void set_up(int socket, const LcmUrl& url, const std::string& interface_name) {
  const int on = 1, off = 0;
  const int buffer = url.receive_buffer > 0 ? url.receive_buffer : kUsualBuffer;
  if (!set(socket, SOL_SOCKET, SO_RCVBUFFORCE, buffer)) {
    set(socket, SOL_SOCKET, SO_RCVBUF, buffer);  // as much of it as is allowed
  }
  set(socket, SOL_SOCKET, SO_TIMESTAMPNS, on);
  // Beside other programs; without the groups that those have joined.
  set(socket, SOL_SOCKET, SO_REUSEADDR, on);
  set(socket, IPPROTO_IP, IP_MULTICAST_ALL, off);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(url.port);
  address.sin_addr.s_addr = htonl(INADDR_ANY);
  if (::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    fail(url, "its port");
  }
  ip_mreqn group{};
  ::inet_pton(AF_INET, url.address.c_str(), &group.imr_multiaddr);
  if (!interface_name.empty()) {
    group.imr_ifindex = static_cast<int>(::if_nametoindex(interface_name.c_str()));
    if (group.imr_ifindex == 0) {
      throw LcmUnavailable(fmt::format("there is no network interface {}", interface_name));
    }
  }
  if (!set(socket, IPPROTO_IP, IP_ADD_MEMBERSHIP, group)) fail(url, "joining the group");
}

// When the kernel received it.
std::int64_t arrival(msghdr& datagram) {
  for (cmsghdr* control = CMSG_FIRSTHDR(&datagram); control != nullptr;
       control = CMSG_NXTHDR(&datagram, control)) {
    if (control->cmsg_level != SOL_SOCKET || control->cmsg_type != SO_TIMESTAMPNS) continue;
    timespec time{};
    std::memcpy(&time, CMSG_DATA(control), sizeof time);
    return std::int64_t{time.tv_sec} * 1'000'000 + time.tv_nsec / 1000;
  }
  return now().wall_us;
}

}  // namespace

UdpReceiver::UdpReceiver(const std::string& url_text, std::vector<std::string> channels,
                         const std::string& interface_name)
    : channels_(std::move(channels)), datagram_(kMostBytes) {
  const LcmUrl url = parse_lcm_url(url_text);
  require_group(url_text, url);
  if (interface_name.empty()) check_route(url);
  socket_ = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (socket_ < 0) fail(url, "no socket");
  try {
    set_up(socket_, url, interface_name);
  } catch (...) {
    ::close(socket_);
    throw;
  }
}

UdpReceiver::~UdpReceiver() {
  ::close(socket_);
}

std::int64_t UdpReceiver::read_datagram() {
  alignas(cmsghdr) std::array<char, 256> control{};
  iovec part{datagram_.data(), datagram_.size()};
  msghdr header{};
  header.msg_iov = &part;
  header.msg_iovlen = 1;
  header.msg_control = control.data();
  header.msg_controllen = control.size();
  const ssize_t size = ::recvmsg(socket_, &header, 0);
  if (size >= 0) arrived_utime_ = arrival(header);
  return size;
}

bool UdpReceiver::hand_over(std::size_t size, const Take& take) const {
  const std::optional<LcmDatagram> parsed = parse_lcm_datagram({datagram_.data(), size});
  if (!parsed ||
      std::find(channels_.begin(), channels_.end(), parsed->channel) == channels_.end()) {
    return false;
  }
  take(parsed->channel, parsed->message, arrived_utime_);
  return true;
}

bool UdpReceiver::receive(int timeout_ms, const Take& take) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point deadline = Clock::now() + std::chrono::milliseconds(timeout_ms);
  int passed_over = 0;
  for (;;) {
    const std::int64_t size = read_datagram();
    if (size >= 0) {
      if (hand_over(static_cast<std::size_t>(size), take)) return true;
      // Somebody who sends nonsense without end must not keep the caller here.
      if (++passed_over == kMostPassedOver) return false;
      continue;
    }
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now()).count();
    if (left <= 0) return false;
    pollfd descriptor = {socket_, POLLIN, 0};
    ::poll(&descriptor, 1, static_cast<int>(left));
  }
}

}  // namespace roundel
