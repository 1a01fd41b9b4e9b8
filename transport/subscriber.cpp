#include "transport/subscriber.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <limits>
#include <stdexcept>

namespace roundel {
namespace {

// Enough for a second of frames in parts; LCM's default of 30 messages loses most of them.
constexpr int kQueuedMessages = 1000;

bool is_channel_prefix(const std::string& prefix) {
  constexpr std::size_t kRoomForSuffix = 16;
  const auto is_allowed = [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '-' || c == '/';
  };
  return !prefix.empty() && prefix.size() <= LCM_MAX_CHANNEL_NAME_LENGTH - kRoomForSuffix &&
         std::all_of(prefix.begin(), prefix.end(), is_allowed);
}

// liblcm 1.3 passes packets on that end before their message begins, with a negative size (which is
// unsigned here).
Bytes bytes_of(const lcm_recv_buf_t* buffer) {
  constexpr std::uint32_t kLargest = std::numeric_limits<std::int32_t>::max();
  if (buffer->data_size > kLargest) return {};
  return {static_cast<const std::uint8_t*>(buffer->data), buffer->data_size};
}

}  // namespace

// LCM keeps its address, so it does not move.
struct Subscriber::State {
  LcmLink link;
  lcm_subscription_t* frames = nullptr;
  lcm_subscription_t* statuses = nullptr;
  FrameAssembler assembler;
  const ReceivedFrame* completed = nullptr;
  std::int64_t received_utime = 0;
  status_t incoming_status{};
  std::optional<status_t> status;

  ~State() {
    if (frames != nullptr) ::lcm_unsubscribe(link.get(), frames);
    if (statuses != nullptr) ::lcm_unsubscribe(link.get(), statuses);
  }

  static void take_frame(const lcm_recv_buf_t* buffer, const char* /*channel*/, void* user) {
    auto* const self = static_cast<State*>(user);
    self->completed = self->assembler.take(bytes_of(buffer));
    self->received_utime = buffer->recv_utime;
  }
  static void take_status(const lcm_recv_buf_t* buffer, const char* /*channel*/, void* user) {
    auto* const self = static_cast<State*>(user);
    if (decode(bytes_of(buffer), self->incoming_status)) self->status = self->incoming_status;
  }
};

Subscriber::Subscriber(LcmLink link, const std::string& channel_prefix)
    : state_(std::make_unique<State>()) {
  if (!is_channel_prefix(channel_prefix)) {
    throw std::invalid_argument(
        fmt::format("\"{}\" is no channel prefix; accepted: 1 to {} of the characters A-Z a-z 0-9 "
                    "_ - /",
                    channel_prefix, LCM_MAX_CHANNEL_NAME_LENGTH - 16));
  }
  state_->link = std::move(link);
  lcm_t* const lcm = state_->link.get();
  state_->frames =
      ::lcm_subscribe(lcm, (channel_prefix + "_FRAME").c_str(), &State::take_frame, state_.get());
  state_->statuses =
      ::lcm_subscribe(lcm, (channel_prefix + "_STATUS").c_str(), &State::take_status, state_.get());
  if (state_->frames == nullptr || state_->statuses == nullptr || descriptor() < 0) {
    throw std::runtime_error("LCM can't receive here (see its message above)");
  }
  ::lcm_subscription_set_queue_capacity(state_->frames, kQueuedMessages);
}

Subscriber::~Subscriber() = default;

int Subscriber::descriptor() const {
  return ::lcm_get_fileno(state_->link.get());
}

const ReceivedFrame* Subscriber::next_frame(std::chrono::milliseconds timeout) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point deadline = Clock::now() + timeout;
  state_->completed = nullptr;
  for (;;) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now()).count();
    const int handled =
        ::lcm_handle_timeout(state_->link.get(), static_cast<int>(std::max<std::int64_t>(0, left)));
    if (state_->completed != nullptr) return state_->completed;
    if (handled < 0 && errno != EINTR) throw std::runtime_error("LCM stopped receiving");
    if (handled <= 0 && left <= 0) return nullptr;
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
