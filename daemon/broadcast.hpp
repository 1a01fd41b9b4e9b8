#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "config/configuration.hpp"
#include "daemon/broadcast_targets.hpp"
#include "transport/publisher.hpp"

namespace roundel {

// A Publisher for the configured URLs, whose networks may have to be waited for. Frames that could
// not be sent to lcm.url count as unsent.
class Broadcast {
 public:
  // Throws LcmUrlError or std::invalid_argument for settings that can't work.
  static void check(const LcmSettings& settings, const std::string& camera);
  // The same.
  Broadcast(const LcmSettings& settings, const std::string& camera);

  bool is_open() const { return targets_->is_open(); }

  void publish(const FrameInformation& information, std::span<const Marker> markers,
               std::span<const ArenaPose> arena = {});
  void publish(const status_t& status) { publisher_.publish(status); }

  // To be called now and then: tries to open again what is not there, when it is time.
  void retry(std::int64_t now_ns) { targets_->retry(now_ns); }

  std::int64_t unsent_frames() const { return publisher_.unsent_frames(); }

 private:
  std::shared_ptr<BroadcastTargets> targets_;
  Publisher publisher_;
};

}  // namespace roundel
