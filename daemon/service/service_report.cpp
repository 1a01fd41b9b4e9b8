#include "daemon/service/service_report.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace roundel {
namespace {

constexpr std::int64_t kSignsPerWatchdog = 4;
constexpr std::int64_t kNsPerMs = 1'000'000;

}  // namespace

ServiceReport::ServiceReport(std::unique_ptr<ServiceLink> link)
    : link_(std::move(link)), period_ns_(link_->watchdog_ns() / kSignsPerWatchdog) {}

void ServiceReport::ready() {
  if (std::exchange(ready_, true)) return;
  link_->send("READY=1");
}

void ServiceReport::status(std::string_view text) {
  next_.clear();
  fmt::format_to(std::back_inserter(next_), "STATUS={}", text);
  std::replace(next_.begin(), next_.end(), '\n', ' ');
  next_.push_back('\0');
  if (std::equal(next_.begin(), next_.end(), told_.begin(), told_.end())) return;
  std::swap(next_, told_);
  link_->send(told_.data());
}

// Before it is ready, the end of a reload would say that it is.
void ServiceReport::begin_reload(std::int64_t now_us) {
  if (!ready_) return;
  link_->send(fmt::format("RELOADING=1\nMONOTONIC_USEC={}", now_us).c_str());
}

void ServiceReport::end_reload() {
  if (ready_) link_->send("READY=1");
}

void ServiceReport::stopping() {
  link_->send("STOPPING=1");
}

void ServiceReport::alive(std::int64_t now_ns) {
  if (period_ns_ == 0 || now_ns < due_ns_) return;
  due_ns_ = now_ns + period_ns_;
  link_->send("WATCHDOG=1");
}

int ServiceReport::sleep_ms(std::int64_t now_ns) const {
  if (period_ns_ == 0) return -1;
  // Overdue is a loop that had nothing to tell; rounded up: woken too early, it would have nothing.
  const std::int64_t left_ns = due_ns_ > now_ns ? due_ns_ - now_ns : period_ns_;
  return static_cast<int>((left_ns + kNsPerMs - 1) / kNsPerMs);
}

}  // namespace roundel
