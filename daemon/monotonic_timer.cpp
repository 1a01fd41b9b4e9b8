#include "daemon/monotonic_timer.hpp"

#include <sys/timerfd.h>

#include <algorithm>
#include <cerrno>
#include <ctime>
#include <system_error>

namespace roundel {

MonotonicTimer::MonotonicTimer()
    : descriptor_(::timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK | TFD_CLOEXEC)) {
  if (!descriptor_) throw std::system_error(errno, std::generic_category(), "timerfd");
}

void MonotonicTimer::arm(std::int64_t instant_ns) {
  constexpr std::int64_t kNsPerSecond = 1'000'000'000;
  instant_ns = std::max<std::int64_t>(1, instant_ns);  // 0 would disarm it
  itimerspec setting{};
  setting.it_value.tv_sec = instant_ns / kNsPerSecond;
  setting.it_value.tv_nsec = instant_ns % kNsPerSecond;
  ::timerfd_settime(descriptor_.get(), TFD_TIMER_ABSTIME, &setting, nullptr);
}

bool MonotonicTimer::take() {
  std::uint64_t expirations = 0;
  return ::read(descriptor_.get(), &expirations, sizeof(expirations)) == sizeof(expirations);
}

}  // namespace roundel
