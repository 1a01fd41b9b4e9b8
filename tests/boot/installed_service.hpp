#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "tests/child_process.hpp"

namespace roundel {

// A unit of this machine's systemd, asked by systemctl and journalctl as anybody would.
class InstalledService {
 public:
  explicit InstalledService(std::string unit) : unit_(std::move(unit)) {}

  std::string property(const std::string& name) const;
  std::int64_t number(const std::string& property_name) const;  // 0 if it is none
  bool is_active() const { return property("ActiveState") == "active"; }
  std::string status() const { return property("StatusText"); }
  int pid() const { return static_cast<int>(number("MainPID")); }
  std::int64_t restarts() const { return number("NRestarts"); }
  // When its program was started, CLOCK_MONOTONIC, microseconds.
  std::int64_t started_us() const { return number("ExecMainStartTimestampMonotonic"); }

  // systemctl VERB; its exit status.
  int systemctl(const std::string& verb) const;
  void signal(const std::string& name) const;

  // What it has written to the journal since it was last forgotten; priorities up to a level of
  // syslog's.
  std::string log(int priority = 7) const;
  void forget_log();

 private:
  std::string unit_;
  std::string since_;
};

// Asks again and again, for half a minute of this machine's time at most.
bool comes_true(const std::function<bool()>& question);

}  // namespace roundel
