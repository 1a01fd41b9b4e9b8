#pragma once

#include "calibration/unique_fd.hpp"

namespace roundel {

// Something to poll for that any thread makes readable without waiting.
class Wakeup {
 public:
  Wakeup();

  int descriptor() const { return descriptor_.get(); }
  void wake();
  // Makes it unreadable; what was waked for is looked at after this.
  void clear();

 private:
  UniqueFd descriptor_;
};

}  // namespace roundel
