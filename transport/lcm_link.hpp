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

struct LcmUrl;

// Throws LcmUnavailable unless the kernel knows the way to the URL's address.
void check_route(const LcmUrl& url);

enum class LcmUse { kSend, kReceive };

// Opens a link of LCM's library. Throws LcmUrlError, or LcmUnavailable (for multicast that means:
// no route).
LcmLink open_lcm(const std::string& url, LcmUse use);

}  // namespace roundel
