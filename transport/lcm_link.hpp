#pragma once

#include <lcm/lcm.h>

#include <memory>
#include <stdexcept>
#include <string>

namespace roundel {

// The URL is right, but the network (or file) is not there (yet): worth another try.
struct LcmUnavailable : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Shared, because memq:// reaches only those who use the same link.
using LcmLink = std::shared_ptr<lcm_t>;

enum class LcmUse { kSend, kReceive };

// Opens a link. Throws LcmUrlError, or LcmUnavailable (for multicast that means: no route).
LcmLink open_lcm(const std::string& url, LcmUse use);

}  // namespace roundel
