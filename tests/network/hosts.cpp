#include "tests/network/hosts.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sched.h>

#include <chrono>
#include <stdexcept>

#include "calibration/unique_fd.hpp"

namespace roundel {
namespace {

std::string failure_of(const std::string& command) {
  const Finished finished = run_program({"/bin/sh", "-ec", command});
  return finished.status == 0 ? "" : fmt::format("{}: {}", command, finished.errors);
}

// In a network of its own, which lives as long as a process that does nothing in it.
std::unique_ptr<ChildProcess> keeper(std::string& reason) {
  auto process = std::make_unique<ChildProcess>(std::vector<std::string>{
      "/usr/bin/unshare", "-n", "/bin/sh", "-c", "echo there; exec sleep 1000"});
  if (!process->wait_for("there", std::chrono::seconds(20))) {
    reason = "unshare -n: " + process->errors();
  }
  return process;
}

}  // namespace

std::optional<Hosts> Hosts::make(int count, std::string& reason) {
  Hosts hosts;
  reason.clear();
  hosts.switch_ = keeper(reason);
  const auto run = [&](const std::string& commands) {
    if (reason.empty()) reason = failure_of(commands);
  };
  run(
      fmt::format("nsenter -n -t {} sh -ec 'ip link add switch type bridge mcast_snooping 0; "
                  "ip link set switch up'",
                  hosts.switch_->pid()));
  for (int host = 0; host < count && reason.empty(); ++host) {
    hosts.keepers_.push_back(keeper(reason));
    const int pid = hosts.keepers_.back()->pid();
    run(fmt::format(
        "nsenter -n -t {1} sh -ec 'ip link add port{0} type veth peer name eth0 netns {2}; "
        "ip link set port{0} master switch up'",
        host, hosts.switch_->pid(), pid));
    run(fmt::format(
        "nsenter -n -t {} sh -ec 'ip link set lo up; ip addr add 10.77.0.{}/24 dev eth0; "
        "ip link set eth0 up; ip route add 239.0.0.0/8 dev eth0'",
        pid, host + 1));
  }
  if (!reason.empty()) return std::nullopt;
  return hosts;
}

std::vector<std::string> Hosts::on(int host, const std::vector<std::string>& command) const {
  const int pid = keepers_[static_cast<std::size_t>(host)]->pid();
  std::vector<std::string> words = {"/usr/bin/nsenter", "-n", "-t", std::to_string(pid)};
  words.insert(words.end(), command.begin(), command.end());
  return words;
}

std::thread Hosts::thread_on(int host, std::function<void()> work) const {
  const int pid = keepers_[static_cast<std::size_t>(host)]->pid();
  return std::thread([pid, work = std::move(work)] {
    const UniqueFd there(::open(fmt::format("/proc/{}/ns/net", pid).c_str(), O_RDONLY | O_CLOEXEC));
    if (!there || ::setns(there.get(), CLONE_NEWNET) != 0) throw std::runtime_error("setns");
    work();
  });
}

}  // namespace roundel
