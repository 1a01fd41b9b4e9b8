#pragma once

#include "calibration/unique_fd.hpp"

namespace roundel {

// Tells when nodes named video... appear in a folder, go, or get other permissions.
class DeviceWatch {
 public:
  // A folder that can't be watched never tells anything.
  explicit DeviceWatch(const char* folder = "/dev");

  int descriptor() const { return descriptor_.get(); }  // to poll
  // Whether there was any such change since the last call.
  bool take();

 private:
  UniqueFd descriptor_;
};

}  // namespace roundel
