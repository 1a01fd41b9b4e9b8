#include "transport/subscriber.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <stdexcept>
#include <vector>

namespace roundel {
namespace {

bool is_channel_prefix(const std::string& prefix) {
  constexpr std::size_t kRoomForSuffix = 16;
  const auto is_allowed = [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '-' || c == '/';
  };
  return !prefix.empty() && prefix.size() <= LCM_MAX_CHANNEL_NAME_LENGTH - kRoomForSuffix &&
         std::all_of(prefix.begin(), prefix.end(), is_allowed);
}

std::vector<std::string> checked_channels(const std::string& prefix) {
  if (!is_channel_prefix(prefix)) {
    throw std::invalid_argument(
        fmt::format("\"{}\" is no channel prefix; accepted: 1 to {} of the characters A-Z a-z 0-9 "
                    "_ - /",
                    prefix, LCM_MAX_CHANNEL_NAME_LENGTH - 16));
  }
  return {prefix + "_FRAME", prefix + "_STATUS"};
}

}  // namespace

struct Subscriber::State {
  std::vector<std::string> channels;  // of frames, of status
  std::unique_ptr<MessageReceiver> receiver;
  FrameAssembler assembler;
  const ReceivedFrame* completed = nullptr;
  std::int64_t received_utime = 0;
  status_t incoming_status{};
  std::optional<status_t> status;

  void take(std::string_view channel, Bytes message, std::int64_t utime) {
    if (channel == channels.front()) {
      completed = assembler.take(message);
      received_utime = utime;
    } else if (decode(message, incoming_status)) {
      status = incoming_status;
    }
  }
};

Subscriber::Subscriber(const std::string& url, const std::string& channel_prefix,
                       const std::string& interface_name)
    : state_(std::make_unique<State>()) {
  state_->channels = checked_channels(channel_prefix);
  state_->receiver = open_receiver(url, state_->channels, interface_name);
}

Subscriber::Subscriber(LcmLink link, const std::string& channel_prefix)
    : state_(std::make_unique<State>()) {
  state_->channels = checked_channels(channel_prefix);
  state_->receiver = make_lcm_receiver(std::move(link), state_->channels);
}

Subscriber::~Subscriber() = default;

int Subscriber::descriptor() const {
  return state_->receiver->descriptor();
}

const ReceivedFrame* Subscriber::next_frame(std::chrono::milliseconds timeout) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point deadline = Clock::now() + timeout;
  const MessageReceiver::Take take = [this](std::string_view channel, Bytes message,
                                            std::int64_t utime) {
    state_->take(channel, message, utime);
  };
  state_->completed = nullptr;
  for (;;) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now()).count();
    const bool handled =
        state_->receiver->receive(static_cast<int>(std::max<std::int64_t>(0, left)), take);
    if (state_->completed != nullptr) return state_->completed;
    if (!handled && left <= 0) return nullptr;
  }
}

std::int64_t Subscriber::received_utime() const {
  return state_->received_utime;
}
const std::optional<status_t>& Subscriber::status() const {
  return state_->status;
}
const ReceptionCounts& Subscriber::counts() const {
  return state_->assembler.counts();
}

}  // namespace roundel
