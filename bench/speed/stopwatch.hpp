#pragma once

#include <time.h>

namespace roundel::bench {

// This thread's processor time in microseconds: what else runs on the machine does not count, but
// for what it throws out of the caches. Every system that is timed works in the calling thread.
inline double thread_time_us() {
  timespec t{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e6 * static_cast<double>(t.tv_sec) + 1e-3 * static_cast<double>(t.tv_nsec);
}

// How long a call takes, in microseconds.
template <typename Call>
double time_of(Call&& call) {
  const double start = thread_time_us();
  call();
  return thread_time_us() - start;
}

}  // namespace roundel::bench
