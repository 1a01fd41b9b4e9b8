#include "daemon/broadcast.hpp"

#include <algorithm>

#include "daemon/log.hpp"
#include "transport/clock.hpp"
#include "transport/lcm_url.hpp"

namespace roundel {
namespace {

constexpr std::int64_t kFirstPauseNs = 500'000'000;
constexpr std::int64_t kLongestPauseNs = 10'000'000'000;

}  // namespace

Broadcast::Broadcast(const LcmSettings& settings, const std::string& camera)
    : settings_(settings),
      parameters_{settings.channel, camera, settings.per_marker, settings.max_datagram},
      pause_ns_(kFirstPauseNs) {
  check(settings, camera);
  retry_at_ns_ = monotonic_ns() + pause_ns_;
  open();
}

void Broadcast::check(const LcmSettings& settings, const std::string& camera) {
  const LcmUrl url = parse_lcm_url(settings.url);
  if (url.provider == LcmUrl::Provider::kLogFile && !url.writing) {
    throw LcmUrlError(fmt::format("\"{}\": to write a log file, add ?mode=w", settings.url));
  }
  FrameEncoder(settings.channel + "_FRAME", camera, settings.max_datagram);
}

bool Broadcast::open() {
  try {
    publisher_.emplace(open_lcm(settings_.url, LcmUse::kSend), parameters_);
    return true;
  } catch (const LcmUnavailable& error) {
    // The first time only: the constructor's.
    if (pause_ns_ == kFirstPauseNs) log_warning("LCM: {}; trying again", error.what());
    return false;
  }
}

void Broadcast::retry(std::int64_t now_ns) {
  if (publisher_ || now_ns < retry_at_ns_) return;
  pause_ns_ = std::min(2 * pause_ns_, kLongestPauseNs);
  retry_at_ns_ = now_ns + pause_ns_;
  if (open()) log_info("LCM: the network is there, poses go out to {}", settings_.url);
}

void Broadcast::publish(const FrameInformation& information, std::span<const Marker> markers,
                        std::span<const ArenaPose> arena) {
  if (!publisher_) {
    ++frames_without_network_;
    return;
  }
  publisher_->publish(information, markers, arena);
  note_sending(publisher_->sending());
}

void Broadcast::publish(const status_t& status) {
  if (publisher_) publisher_->publish(status);
}

void Broadcast::note_sending(bool sending) {
  if (sending == was_sending_) return;
  was_sending_ = sending;
  if (sending) {
    log_info("LCM: frames go out again");
  } else {
    log_warning("LCM: frames can't be sent to {} (is the network interface down?)", settings_.url);
  }
}

std::int64_t Broadcast::unsent_frames() const {
  return frames_without_network_ + (publisher_ ? publisher_->unsent_frames() : 0);
}

}  // namespace roundel
