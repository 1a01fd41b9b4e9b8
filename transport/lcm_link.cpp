#include "transport/lcm_link.hpp"

#include <fmt/format.h>

#include <cstring>

#include "transport/lcm_url.hpp"
#include "transport/route.hpp"

namespace roundel {

void check_route(const LcmUrl& url) {
  const int error = find_route(url.address, url.port).error;
  if (error == 0) return;
  if (!url.is_multicast()) {
    throw LcmUnavailable(fmt::format("no route to {} ({})", url.address, std::strerror(error)));
  }
  throw LcmUnavailable(
      fmt::format("no route to the multicast group {} ({}); one is made by: ip route add "
                  "239.0.0.0/8 dev INTERFACE (lo for this machine alone)",
                  url.address, std::strerror(error)));
}

LcmLink open_lcm(const std::string& url, LcmUse use) {
  const LcmUrl parsed = parse_lcm_url(url);
  if (parsed.provider == LcmUrl::Provider::kLogFile && parsed.writing != (use == LcmUse::kSend)) {
    throw LcmUrlError(fmt::format(
        "\"{}\": {}", url,
        use == LcmUse::kSend ? "to write a log file, add ?mode=w" : "mode=w can't be listened to"));
  }
  // Asked here, because lcm_create() reports a missing route by several lines on standard error.
  if (parsed.provider == LcmUrl::Provider::kUdp) {
    require_group(url, parsed);
    check_route(parsed);
  }
  LcmLink link(::lcm_create(url.c_str()), [](lcm_t* lcm) {
    if (lcm != nullptr) ::lcm_destroy(lcm);
  });
  if (!link) throw LcmUnavailable(fmt::format("LCM can't open \"{}\"", url));
  return link;
}

}  // namespace roundel
