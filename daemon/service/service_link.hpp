#pragma once

#include <cstdint>
#include <memory>

namespace roundel {

// The way to the service manager that started this program. Tests may listen at its other end.
class ServiceLink {
 public:
  ServiceLink() = default;
  virtual ~ServiceLink() = default;
  ServiceLink(const ServiceLink&) = delete;
  ServiceLink& operator=(const ServiceLink&) = delete;

  // Lines "NAME=value" as sd_notify(3) describes them.
  virtual void send(const char* lines) = 0;
  // Without a sign of life for so long it ends this program; 0: it does not ask for any.
  virtual std::int64_t watchdog_ns() const = 0;
};

// systemd, if it waits for notifications (NOTIFY_SOCKET); otherwise a link that leads nowhere.
std::unique_ptr<ServiceLink> service_manager();

}  // namespace roundel
