#pragma once

#include <doctest/doctest.h>
#include <ifaddrs.h>
#include <net/if.h>

#include <memory>
#include <string>

#include "transport/message_sender.hpp"

namespace roundel {

// The first interface besides loopback that is up; empty if there is none.
inline std::string outside_interface() {
  ifaddrs* list = nullptr;
  if (::getifaddrs(&list) != 0) return "unknown";
  const std::unique_ptr<ifaddrs, void (*)(ifaddrs*)> owner(list, ::freeifaddrs);
  for (const ifaddrs* entry = list; entry != nullptr; entry = entry->ifa_next) {
    if ((entry->ifa_flags & IFF_UP) != 0 && (entry->ifa_flags & IFF_LOOPBACK) == 0) {
      return entry->ifa_name;
    }
  }
  return {};
}

// Whether this is a private network namespace with nothing but loopback and a multicast route, as
// ./dev test makes (unshare -rn; ip link set lo up; ip route add 239.0.0.0/8 dev lo). Otherwise a
// network test must not run, and this says so.
inline bool multicast_is_private() {
  std::string reason;
  const std::string outside = outside_interface();
  if (outside.empty()) {
    try {
      open_sender("udpm://239.255.76.67:7667?ttl=0");
      return true;
    } catch (const LcmUnavailable& error) {
      reason = error.what();
    }
  } else {
    reason = "interface " + outside + " is up";
  }
  MESSAGE("skipped: not in a private network namespace (./dev test makes one): " << reason);
  return false;
}

}  // namespace roundel
