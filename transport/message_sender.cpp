#include "transport/message_sender.hpp"

#include "transport/lcm_url.hpp"
#include "transport/udp_sender.hpp"

namespace roundel {

bool LcmSender::send(const char* channel, Bytes message) {
  return ::lcm_publish(link_.get(), channel, message.data(),
                       static_cast<unsigned int>(message.size())) == 0;
}

std::unique_ptr<MessageSender> open_sender(const std::string& url,
                                           const std::string& interface_name) {
  const LcmUrl parsed = parse_lcm_url(url);
  if (parsed.provider == LcmUrl::Provider::kUdp) {
    return std::make_unique<UdpSender>(parsed, interface_name);
  }
  return std::make_unique<LcmSender>(open_lcm(url, LcmUse::kSend));
}

}  // namespace roundel
