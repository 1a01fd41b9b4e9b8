#pragma once

#include <poll.h>

namespace roundel {

// Whether a descriptor becomes readable within the time.
inline bool wait_for_descriptor(int descriptor, int timeout_ms) {
  pollfd entry = {descriptor, POLLIN, 0};
  return ::poll(&entry, 1, timeout_ms) == 1;
}

}  // namespace roundel
