#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <random>

#include "tools/doctor/network_checks.hpp"
#include "transport/lcm_url.hpp"
#include "transport/message_receiver.hpp"
#include "transport/message_sender.hpp"

namespace roundel {
namespace {

constexpr const char* kChannel = "ROUNDEL_DOCTOR";

bool comes_back(const LcmUrl& url, const std::string& interface_name,
                std::chrono::milliseconds patience) {
  using Clock = std::chrono::steady_clock;
  // ttl=0: the test shall not be heard elsewhere.
  const std::string test_url = fmt::format("udpm://{}:{}?ttl=0", url.address, url.port);
  std::array<std::uint8_t, 8> token{};
  std::random_device random;
  for (std::uint8_t& byte : token) byte = static_cast<std::uint8_t>(random());
  // Joined as other programs here join it: as the routes say.
  const std::unique_ptr<MessageReceiver> receiver = open_receiver(test_url, {kChannel});
  const std::unique_ptr<MessageSender> sender = open_sender(test_url, interface_name);
  bool arrived = false;
  const auto deadline = Clock::now() + patience;
  while (!arrived && Clock::now() < deadline) {
    sender->send(kChannel, token);
    receiver->receive(static_cast<int>(patience.count() / 4 + 1), [&](std::string_view,
                                                                      Bytes message, std::int64_t) {
      arrived = arrived || std::equal(message.begin(), message.end(), token.begin(), token.end());
    });
  }
  return arrived;
}

}  // namespace

Finding check_loopback(const LcmSettings& settings, std::chrono::milliseconds patience) {
  const LcmUrl url = parse_lcm_url(settings.url);
  if (!url.is_multicast()) return {"loopback", Verdict::kOk, "not tried: no multicast", ""};
  try {
    if (comes_back(url, settings.interface_name, patience)) {
      return {"loopback", Verdict::kOk, "a message to the group comes back to this machine", ""};
    }
  } catch (const std::runtime_error& error) {
    return {"loopback", Verdict::kProblem, error.what(), "see route and interface above"};
  }
  return {
      "loopback", Verdict::kProblem, "a message to the group does not come back to this machine",
      settings.interface_name.empty()
          ? "see firewall above (sudo nft list ruleset, sudo iptables -L -n)"
          : "programs here receive by the route, not by lcm.interface: they should be the same; "
            "or see firewall above"};
}

}  // namespace roundel
