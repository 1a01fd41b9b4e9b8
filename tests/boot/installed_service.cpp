#include "tests/boot/installed_service.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>

#include "transport/clock.hpp"

namespace roundel {
namespace {

std::string first_line(const std::string& text) {
  return text.substr(0, text.find('\n'));
}

}  // namespace

std::string InstalledService::property(const std::string& name) const {
  return first_line(
      run_program({"/usr/bin/systemctl", "show", "--value", "-p", name, unit_}).output);
}

std::int64_t InstalledService::number(const std::string& property_name) const {
  return std::strtoll(property(property_name).c_str(), nullptr, 10);
}

int InstalledService::systemctl(const std::string& verb) const {
  return run_program({"/usr/bin/systemctl", verb, unit_}).status;
}

void InstalledService::signal(const std::string& name) const {
  run_program({"/usr/bin/systemctl", "kill", "--kill-who=main", "-s", name, unit_});
}

std::string InstalledService::log(int priority) const {
  std::vector<std::string> command = {
      "/usr/bin/journalctl",    "--no-pager", "-q", "-o", "cat", "-p",
      std::to_string(priority), "-u",         unit_};
  if (!since_.empty()) command.push_back(since_);
  return run_program(command).output;
}

// By the second: journalctl --after-cursor leaves out the first line that it should show (systemd
// 252, with a filter).
void InstalledService::forget_log() {
  constexpr std::int64_t kSecondUs = 1'000'000;
  const std::int64_t wall_us = now().wall_us;
  since_ = fmt::format("--since=@{}", wall_us / kSecondUs + 1);
  ::usleep(static_cast<useconds_t>(kSecondUs - wall_us % kSecondUs));
}

bool comes_true(const std::function<bool()>& question) {
  constexpr std::int64_t kPatienceUs = 30'000'000;
  const std::int64_t end_us = now().mono_us + kPatienceUs;
  while (now().mono_us < end_us) {
    if (question()) return true;
    ::usleep(100'000);
  }
  return false;
}

}  // namespace roundel
