#pragma once

#include <time.h>

#include <chrono>

namespace roundel::bench {

// This thread's processor time in microseconds: what else runs on the machine does not count, but
// for what it throws out of the caches. Every system that is timed works in the calling thread.
inline double thread_time_us() {
  timespec t{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e6 * static_cast<double>(t.tv_sec) + 1e-3 * static_cast<double>(t.tv_nsec);
}

// The same by the clock on the wall, for what several threads do: it needs a quiet machine.
template <typename Call>
double wall_time_of(Call&& call) {
  const auto start = std::chrono::steady_clock::now();
  call();
  return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start)
      .count();
}

// How long a call takes, in microseconds.
template <typename Call>
double time_of(Call&& call) {
  const double start = thread_time_us();
  call();
  return thread_time_us() - start;
}

}  // namespace roundel::bench
