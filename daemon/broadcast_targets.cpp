#include "daemon/broadcast_targets.hpp"

#include <algorithm>
#include <utility>

#include "daemon/log.hpp"
#include "transport/clock.hpp"
#include "transport/lcm_url.hpp"

namespace roundel {
namespace {

constexpr std::int64_t kFirstPauseNs = 500'000'000;
constexpr std::int64_t kLongestPauseNs = 10'000'000'000;

}  // namespace

void BroadcastTargets::check_url(const LcmSettings& settings) {
  const LcmUrl url = parse_lcm_url(settings.url);
  if (url.provider == LcmUrl::Provider::kLogFile && !url.writing) {
    throw LcmUrlError(fmt::format("\"{}\": to write a log file, add ?mode=w", settings.url));
  }
}

void BroadcastTargets::check_copies(const LcmSettings& settings) {
  for (const std::string& copy : settings.copies) {
    if (parse_lcm_url(copy).provider != LcmUrl::Provider::kUdp) {
      throw LcmUrlError(fmt::format(
          "\"{}\" is no network; accepted: udpm:// with the address of a machine or of a multicast "
          "group",
          copy));
    }
  }
}

BroadcastTargets::BroadcastTargets(const LcmSettings& settings)
    : interface_(settings.interface_name) {
  check_url(settings);
  check_copies(settings);
  targets_.resize(1 + settings.copies.size());
  targets_.front().url = settings.url;
  for (std::size_t i = 0; i < settings.copies.size(); ++i) targets_[i + 1].url = settings.copies[i];
  for (Target& target : targets_) open(target, true);
}

void BroadcastTargets::open(Target& target, bool first) {
  target.pause_ns = first ? kFirstPauseNs : std::min(2 * target.pause_ns, kLongestPauseNs);
  target.retry_at_ns = monotonic_ns() + target.pause_ns;
  try {
    target.sender = open_sender(target.url, interface_);
    if (std::exchange(target.told_missing, false)) {
      log_info("LCM: the network is there, poses go out to {}", target.url);
    }
  } catch (const LcmUnavailable& error) {
    if (!first) return;
    target.told_missing = true;
    log_warning("LCM: {}: {}; trying again", target.url, error.what());
  }
}

bool BroadcastTargets::send(const char* channel, Bytes message) {
  bool sent_to_first = false;
  for (std::size_t i = 0; i < targets_.size(); ++i) {
    Target& target = targets_[i];
    const bool sent = target.sender && target.sender->send(channel, message);
    target.sending = target.sending && sent;
    if (i == 0) sent_to_first = sent;
  }
  return sent_to_first;
}

void BroadcastTargets::note_sending() {
  for (Target& target : targets_) {
    const bool sending = std::exchange(target.sending, true);
    if (!target.sender || sending == target.was_sending) continue;
    target.was_sending = sending;
    if (sending) {
      log_info("LCM: messages go out to {} again", target.url);
    } else {
      log_warning("LCM: messages can't be sent to {} (is the network interface down?)", target.url);
    }
  }
}

void BroadcastTargets::retry(std::int64_t now_ns) {
  for (Target& target : targets_) {
    // A socket that was bound to an interface does not follow it when it is plugged in again. Until
    // there is a new one, the old one is tried.
    const bool needed = !target.sender || !target.was_sending;
    if (needed && now_ns >= target.retry_at_ns) open(target, false);
  }
}

}  // namespace roundel
