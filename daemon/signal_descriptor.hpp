#pragma once

#include "calibration/unique_fd.hpp"

namespace roundel {

enum class SignalEvent { kNone, kStop, kReload };

// SIGINT, SIGTERM and SIGHUP as something to poll for. Made once, before any other thread: the
// signals are blocked from then on.
class SignalDescriptor {
 public:
  SignalDescriptor();

  int descriptor() const { return descriptor_.get(); }
  // The next signal that has come; kNone if there is none.
  SignalEvent take();

 private:
  UniqueFd descriptor_;
};

}  // namespace roundel
