#include "transport/route.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <fstream>
#include <sstream>

namespace roundel {
namespace {

class DatagramSocket {
 public:
  DatagramSocket() : descriptor_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {}
  ~DatagramSocket() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  DatagramSocket(const DatagramSocket&) = delete;
  DatagramSocket& operator=(const DatagramSocket&) = delete;
  int get() const { return descriptor_; }

 private:
  int descriptor_;
};

// From the kernel's table as text: netlink is closed to the service.
std::string interface_to(const in_addr& address) {
  std::ifstream table("/proc/self/net/route");
  std::string line, best;
  std::getline(table, line);  // names of the columns
  std::uint32_t best_mask = 0;
  int best_metric = 0;
  while (std::getline(table, line)) {
    std::istringstream words(line);
    std::string interface, gateway, flags, references, uses;
    std::uint32_t destination = 0, mask = 0;
    int metric = 0;
    words >> interface >> std::hex >> destination >> gateway >> flags >> references >> uses >>
        std::dec >> metric >> std::hex >> mask;
    if (!words || (address.s_addr & mask) != destination) continue;
    // Both in network order: compared as numbers only after turning them round.
    const bool better = best.empty() || ntohl(mask) > ntohl(best_mask) ||
                        (mask == best_mask && metric < best_metric);
    if (!better) continue;
    best = interface;
    best_mask = mask;
    best_metric = metric;
  }
  return best;
}

}  // namespace

// The kernel looks a route up when a datagram socket is connected.
Route find_route(const std::string& address, std::uint16_t port) {
  const DatagramSocket socket;
  if (socket.get() < 0) return {errno, {}, {}};
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(port);
  if (::inet_pton(AF_INET, address.c_str(), &to.sin_addr) != 1) return {EINVAL, {}, {}};
  if (::connect(socket.get(), reinterpret_cast<const sockaddr*>(&to), sizeof to) != 0) {
    return {errno, {}, {}};
  }
  Route route;
  route.interface = interface_to(to.sin_addr);
  sockaddr_in from{};
  socklen_t length = sizeof from;
  if (::getsockname(socket.get(), reinterpret_cast<sockaddr*>(&from), &length) != 0) return route;
  if (from.sin_addr.s_addr == INADDR_ANY) return route;  // none that others could reach
  std::array<char, INET_ADDRSTRLEN> text{};
  if (::inet_ntop(AF_INET, &from.sin_addr, text.data(), text.size()) != nullptr) {
    route.address = text.data();
  }
  return route;
}

}  // namespace roundel
