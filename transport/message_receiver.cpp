#include "transport/message_receiver.hpp"

#include <cerrno>
#include <limits>
#include <stdexcept>

#include "transport/lcm_url.hpp"
#include "transport/udp_receiver.hpp"

namespace roundel {
namespace {

// Enough for a second of frames in parts; LCM's default of 30 messages loses most of them.
constexpr int kQueuedMessages = 1000;

class LcmReceiver final : public MessageReceiver {
 public:
  LcmReceiver(LcmLink link, const std::vector<std::string>& channels) : link_(std::move(link)) {
    for (const std::string& channel : channels) {
      lcm_subscription_t* const subscription =
          ::lcm_subscribe(link_.get(), channel.c_str(), &LcmReceiver::handle, this);
      if (subscription == nullptr) throw std::runtime_error(kCannotReceive);
      subscriptions_.push_back(subscription);
      ::lcm_subscription_set_queue_capacity(subscription, kQueuedMessages);
    }
    if (descriptor() < 0) throw std::runtime_error(kCannotReceive);
  }
  ~LcmReceiver() override {
    for (lcm_subscription_t* const subscription : subscriptions_) {
      ::lcm_unsubscribe(link_.get(), subscription);
    }
  }

  int descriptor() const override { return ::lcm_get_fileno(link_.get()); }

  bool receive(int timeout_ms, const Take& take) override {
    take_ = &take;
    const int handled = ::lcm_handle_timeout(link_.get(), timeout_ms);
    if (handled < 0 && errno != EINTR) throw std::runtime_error("LCM stopped receiving");
    return handled > 0;
  }

 private:
  static constexpr const char* kCannotReceive = "LCM can't receive here (see its message above)";

  static void handle(const lcm_recv_buf_t* buffer, const char* channel, void* self) {
    // liblcm 1.3 passes packets on that end before their message begins, with a negative size
    // (which is unsigned here).
    constexpr std::uint32_t kLargest = std::numeric_limits<std::int32_t>::max();
    Bytes message;
    if (buffer->data_size <= kLargest) {
      message = {static_cast<const std::uint8_t*>(buffer->data), buffer->data_size};
    }
    (*static_cast<LcmReceiver*>(self)->take_)(channel, message, buffer->recv_utime);
  }

  LcmLink link_;
  std::vector<lcm_subscription_t*> subscriptions_;
  const Take* take_ = nullptr;  // during receive()
};

}  // namespace

std::unique_ptr<MessageReceiver> make_lcm_receiver(LcmLink link,
                                                   const std::vector<std::string>& channels) {
  return std::make_unique<LcmReceiver>(std::move(link), channels);
}

std::unique_ptr<MessageReceiver> open_receiver(const std::string& url,
                                               const std::vector<std::string>& channels,
                                               const std::string& interface_name) {
  const LcmUrl parsed = parse_lcm_url(url);
  if (parsed.provider == LcmUrl::Provider::kUdp) {
    return std::make_unique<UdpReceiver>(url, channels, interface_name);
  }
  return make_lcm_receiver(open_lcm(url, LcmUse::kReceive), channels);
}

}  // namespace roundel
