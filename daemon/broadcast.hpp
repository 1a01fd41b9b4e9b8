#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "config/configuration.hpp"
#include "transport/publisher.hpp"

namespace roundel {

// A Publisher that may have to wait for its network: as long as there is no route, frames count as
// unsent, and opening is tried again with growing pauses. The log hears of each change once.
class Broadcast {
 public:
  // Throws LcmUrlError or std::invalid_argument for settings that can't work.
  static void check(const LcmSettings& settings, const std::string& camera);
  // The same.
  Broadcast(const LcmSettings& settings, const std::string& camera);

  bool is_open() const { return publisher_.has_value(); }
  const LcmSettings& settings() const { return settings_; }

  // Both do nothing but count while the network is not there.
  void publish(const FrameInformation& information, std::span<const Marker> markers,
               std::span<const ArenaPose> arena = {});
  void publish(const status_t& status);

  // To be called now and then: tries to open again when it is time.
  void retry(std::int64_t now_ns);

  std::int64_t unsent_frames() const;

 private:
  bool open();
  void note_sending(bool sending);

  LcmSettings settings_;
  PublisherParameters parameters_;
  std::optional<Publisher> publisher_;
  std::int64_t frames_without_network_ = 0;
  std::int64_t retry_at_ns_ = 0;
  std::int64_t pause_ns_ = 0;
  bool was_sending_ = true;
};

}  // namespace roundel
