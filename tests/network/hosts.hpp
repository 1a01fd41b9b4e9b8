#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "tests/child_process.hpp"

namespace roundel {

// Machines on one switch: network namespaces, each with a cable (veth) to a bridge, an address and
// a route for multicast. Nothing is added to the network that the test runs in.
class Hosts {
 public:
  // Nothing if the kernel does not let us; `reason` says why.
  static std::optional<Hosts> make(int count, std::string& reason);

  // Words to put before a command so that it runs on a host.
  std::vector<std::string> on(int host, const std::vector<std::string>& command) const;
  // The same for a piece of this program: a thread that opens its sockets there.
  std::thread thread_on(int host, std::function<void()> work) const;

 private:
  std::unique_ptr<ChildProcess> switch_;
  std::vector<std::unique_ptr<ChildProcess>> keepers_;
};

}  // namespace roundel
