#include "transport/clock.hpp"

#include <ctime>

namespace roundel {
namespace {

std::int64_t read_ns(clockid_t clock) {
  constexpr std::int64_t kNsPerSecond = 1'000'000'000;
  timespec time{};
  ::clock_gettime(clock, &time);
  return time.tv_sec * kNsPerSecond + time.tv_nsec;
}

}  // namespace

TimeStamp now() {
  constexpr std::int64_t kNsPerUs = 1000;
  return {read_ns(CLOCK_REALTIME) / kNsPerUs, read_ns(CLOCK_MONOTONIC) / kNsPerUs};
}

std::int64_t monotonic_ns() {
  return read_ns(CLOCK_MONOTONIC);
}

}  // namespace roundel
