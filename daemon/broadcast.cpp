#include "daemon/broadcast.hpp"

namespace roundel {

Broadcast::Broadcast(const LcmSettings& settings, const std::string& camera)
    : targets_(std::make_shared<BroadcastTargets>(settings)),
      publisher_(targets_, {settings.channel, camera, settings.per_marker, settings.max_datagram}) {
}

void Broadcast::check(const LcmSettings& settings, const std::string& camera) {
  BroadcastTargets::check_url(settings);
  BroadcastTargets::check_copies(settings);
  FrameEncoder(settings.channel + "_FRAME", camera, settings.max_datagram);
}

void Broadcast::publish(const FrameInformation& information, std::span<const Marker> markers,
                        std::span<const ArenaPose> arena) {
  publisher_.publish(information, markers, arena);
  targets_->note_sending();
}

}  // namespace roundel
