#pragma once

#include <chrono>
#include <cstddef>
#include <string>

#include "config/configuration.hpp"
#include "tools/doctor/finding.hpp"
#include "transport/route.hpp"

namespace roundel {

// lcm.url: whether poses leave this machine.
Finding check_url(const LcmSettings& settings);
// The way to its address, and the interface that poses leave by. `route` is find_route() to it.
Finding check_route(const LcmSettings& settings, const Route& route);
Finding check_interface(const MachineRoot& root, const LcmSettings& settings, const Route& route);
// Known firewalls that are on.
Finding check_firewall(const MachineRoot& root, const LcmSettings& settings);
// Whether a frame with so many markers fits what a receiver on this machine may leave waiting.
Finding check_buffers(const MachineRoot& root, std::size_t markers);
// Sends a message to the group and waits until it comes back. It does not leave the machine.
Finding check_loopback(const LcmSettings& settings, std::chrono::milliseconds patience);

}  // namespace roundel
