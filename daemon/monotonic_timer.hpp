#pragma once

#include <cstdint>

#include "calibration/unique_fd.hpp"

namespace roundel {

// Something to poll for that becomes readable at an instant of CLOCK_MONOTONIC. Instants are
// absolute, so being late once does not shift the ones that follow.
class MonotonicTimer {
 public:
  MonotonicTimer();

  int descriptor() const { return descriptor_.get(); }
  // Replaces the instant; one in the past is due at once.
  void arm(std::int64_t instant_ns);
  // Whether the instant has come; once for each.
  bool take();

 private:
  UniqueFd descriptor_;
};

}  // namespace roundel
