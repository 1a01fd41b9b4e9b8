#include "tools/doctor/network_checks.hpp"

#include <fmt/format.h>
#include <net/if.h>

#include <algorithm>
#include <cstdint>
#include <sstream>

#include "transport/lcm_url.hpp"
#include "transport/messages.hpp"

namespace roundel {
namespace {

bool is_wireless(const MachineRoot& root, const std::string& name) {
  return root.exists("/sys/class/net/" + name + "/wireless") ||
         root.exists("/sys/class/net/" + name + "/phy80211");
}

std::int64_t number_in(const MachineRoot& root, const std::string& path) {
  std::istringstream text(root.read(path));
  std::int64_t number = 0;
  return text >> number ? number : 0;
}

// Datagrams that found no room in a receiver, since the machine started.
std::int64_t receive_errors(const MachineRoot& root) {
  std::istringstream lines(root.read("/proc/net/snmp"));
  std::string names, values;
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("Udp:")) continue;
    (names.empty() ? names : values) = line;
  }
  std::istringstream name_words(names), value_words(values);
  for (std::string name, value; name_words >> name && value_words >> value;) {
    if (name == "RcvbufErrors") return std::strtoll(value.c_str(), nullptr, 10);
  }
  return 0;
}

}  // namespace

Finding check_url(const LcmSettings& settings) {
  const LcmUrl url = parse_lcm_url(settings.url);
  if (url.provider != LcmUrl::Provider::kUdp) {
    return {"lcm.url", Verdict::kWarning, fmt::format("{} reaches no robot", settings.url),
            "set lcm.url: udpm://239.255.76.67:7667?ttl=1"};
  }
  if (url.is_multicast() && url.ttl == 0 && settings.copies.empty()) {
    return {"lcm.url", Verdict::kWarning,
            fmt::format("{}: with ttl=0 poses stay on this machine", settings.url),
            "if robots are elsewhere, set ?ttl=1 in lcm.url"};
  }
  const std::string copies =
      settings.copies.empty() ? "" : fmt::format(", and {} copies", settings.copies.size());
  return {"lcm.url", Verdict::kOk, fmt::format("poses go to {}{}", settings.url, copies), ""};
}

Finding check_route(const LcmSettings& settings, const Route& route) {
  const LcmUrl url = parse_lcm_url(settings.url);
  if (url.provider != LcmUrl::Provider::kUdp) {
    return {"route", Verdict::kOk, "none is needed", ""};
  }
  const std::string& name = route.interface;
  if (route.error == 0 && name == "lo" && url.is_multicast() && url.ttl > 0 &&
      settings.interface_name.empty()) {
    return {"route", Verdict::kWarning,
            fmt::format("{} goes to lo, so poses stay on this machine", url.address),
            "set lcm.interface, or: sudo ip route replace 239.0.0.0/8 dev INTERFACE"};
  }
  if (route.error == 0) {
    return {"route", Verdict::kOk, fmt::format("{} goes to {}", url.address, name), ""};
  }
  if (!url.is_multicast()) {
    return {"route", Verdict::kProblem, fmt::format("there is no way to {}", url.address),
            "see ip address and ip route"};
  }
  // roundeld can do without, but the library that programs on this machine receive with can not.
  const bool named = !settings.interface_name.empty();
  return {"route", named ? Verdict::kWarning : Verdict::kProblem,
          fmt::format("there is no route to the multicast group {}{}", url.address,
                      named ? "; programs on this machine can't receive" : ""),
          fmt::format("sudo ip route add 239.0.0.0/8 dev {}",
                      named ? settings.interface_name : "INTERFACE (lo: this machine alone)")};
}

Finding check_interface(const MachineRoot& root, const LcmSettings& settings, const Route& route) {
  const LcmUrl url = parse_lcm_url(settings.url);
  const bool named = url.is_multicast() && !settings.interface_name.empty();
  const std::string name = url.provider != LcmUrl::Provider::kUdp ? ""
                           : named                                ? settings.interface_name
                                                                  : route.interface;
  if (name.empty()) return {"interface", Verdict::kOk, "no interface is in use", ""};
  const std::string folder = "/sys/class/net/" + name;
  if (!root.exists(folder)) {
    return {"interface", Verdict::kProblem, fmt::format("there is no network interface {}", name),
            "name one that ip link lists in lcm.interface"};
  }
  const unsigned long flags = std::strtoul(root.read(folder + "/flags").c_str(), nullptr, 16);
  if ((flags & IFF_UP) == 0) {
    return {"interface", Verdict::kProblem, fmt::format("{} is down", name),
            fmt::format("sudo ip link set {} up", name)};
  }
  if (name != "lo" && root.read(folder + "/carrier") == "0") {
    return {"interface", Verdict::kProblem, fmt::format("{} has no cable or no network", name),
            "plug it in, or join the Wi-Fi"};
  }
  if (name != "lo" && url.is_multicast() && (flags & IFF_MULTICAST) == 0) {
    return {"interface", Verdict::kProblem, fmt::format("{} has multicast turned off", name),
            fmt::format("sudo ip link set {} multicast on", name)};
  }
  if (url.is_multicast() && url.ttl > 0 && is_wireless(root, name)) {
    return {"interface", Verdict::kWarning,
            fmt::format("{} is Wi-Fi, which sends multicast slowly and loses much of it", name),
            "give the robots' addresses in lcm.copies, or use a cable to the access point"};
  }
  return {"interface", Verdict::kOk, fmt::format("{} is up", name), ""};
}

Finding check_firewall(const MachineRoot& root, const LcmSettings& settings) {
  const LcmUrl url = parse_lcm_url(settings.url);
  if (root.read("/etc/ufw/ufw.conf").find("\nENABLED=yes") != std::string::npos) {
    return {"firewall", Verdict::kWarning, "ufw is on; it may keep poses from programs here",
            fmt::format("sudo ufw allow in proto udp to {} port {}", url.address, url.port)};
  }
  if (root.exists("/run/firewalld") || root.exists("/var/run/firewalld.pid")) {
    return {"firewall", Verdict::kWarning, "firewalld is on; it may keep poses from programs here",
            fmt::format("sudo firewall-cmd --permanent --add-port={}/udp", url.port)};
  }
  const bool starts_nftables =
      root.exists("/etc/systemd/system/sysinit.target.wants/nftables.service");
  const bool drops = root.read("/etc/nftables.conf").find("drop") != std::string::npos;
  if (starts_nftables && drops) {
    return {"firewall", Verdict::kWarning, "/etc/nftables.conf drops packets",
            fmt::format("add to its input chain: udp dport {} accept", url.port)};
  }
  return {"firewall", Verdict::kOk, "neither ufw nor firewalld nor nftables.conf is in the way",
          ""};
}

Finding check_buffers(const MachineRoot& root, std::size_t markers) {
  constexpr std::size_t kFramesWaiting = 4;
  // Small datagrams cost a receiver's buffer about twice their size.
  const auto marker_bytes = static_cast<std::size_t>(marker_t()._getEncodedSizeNoHash());
  const std::size_t wanted = kFramesWaiting * 2 * (400 + markers * marker_bytes);
  const std::int64_t room = number_in(root, "/proc/sys/net/core/rmem_default");
  const std::int64_t most = number_in(root, "/proc/sys/net/core/rmem_max");
  if (room > 0 && static_cast<std::size_t>(room) < wanted) {
    return {"buffers", Verdict::kWarning,
            fmt::format("receivers have {} bytes, but {} frames of {} markers may take {}", room,
                        kFramesWaiting, markers, wanted),
            fmt::format("sudo sysctl net.core.rmem_default={0} net.core.rmem_max={0}",
                        std::max<std::size_t>(wanted, 2'000'000))};
  }
  if (const std::int64_t errors = receive_errors(root); errors > 0) {
    return {
        "buffers", Verdict::kWarning,
        fmt::format("{} datagrams found no room in a receiver since this machine started", errors),
        "if the number rises (cat /proc/net/snmp), a program here reads too slowly, or: sudo "
        "sysctl net.core.rmem_default=2000000"};
  }
  return {"buffers", Verdict::kOk,
          fmt::format("receivers have {} bytes, at most {}; nothing was lost", room, most), ""};
}

}  // namespace roundel
