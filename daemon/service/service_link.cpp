#include "daemon/service/service_link.hpp"

#include <systemd/sd-daemon.h>

#include <cstdlib>

namespace roundel {
namespace {

class NoServiceManager final : public ServiceLink {
 public:
  void send(const char* /*lines*/) override {}
  std::int64_t watchdog_ns() const override { return 0; }
};

class Systemd final : public ServiceLink {
 public:
  // Nothing can be done about a manager that does not listen, so that errors are left alone.
  void send(const char* lines) override { ::sd_notify(kKeepEnvironment, lines); }

  std::int64_t watchdog_ns() const override {
    std::uint64_t period_us = 0;
    const bool wanted = ::sd_watchdog_enabled(kKeepEnvironment, &period_us) > 0;
    return wanted ? static_cast<std::int64_t>(period_us) * 1000 : 0;
  }

 private:
  static constexpr int kKeepEnvironment = 0;
};

}  // namespace

std::unique_ptr<ServiceLink> service_manager() {
  if (std::getenv("NOTIFY_SOCKET") == nullptr) return std::make_unique<NoServiceManager>();
  return std::make_unique<Systemd>();
}

}  // namespace roundel
