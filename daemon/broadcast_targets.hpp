#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "config/configuration.hpp"
#include "transport/message_sender.hpp"

namespace roundel {

// lcm.url and lcm.copies: every message goes to each of them. One whose network is not there (yet,
// or any more) is opened again with growing pauses. The log hears of each change once.
class BroadcastTargets final : public MessageSender {
 public:
  // They throw LcmUrlError for URLs that can't work.
  static void check_url(const LcmSettings& settings);
  static void check_copies(const LcmSettings& settings);
  explicit BroadcastTargets(const LcmSettings& settings);

  // Whether it went to lcm.url; nobody counts for the copies.
  bool send(const char* channel, Bytes message) override;

  // To be called between frames: tells what has changed.
  void note_sending();
  // To be called now and then.
  void retry(std::int64_t now_ns);

  // lcm.url.
  bool is_open() const { return targets_.front().sender != nullptr; }

 private:
  struct Target {
    std::string url;
    std::unique_ptr<MessageSender> sender;  // none: its network is not there
    bool sending = true;                    // since note_sending() looked last, all of it
    bool was_sending = true, told_missing = false;
    std::int64_t retry_at_ns = 0, pause_ns = 0;
  };
  void open(Target& target, bool first);

  std::string interface_;
  std::vector<Target> targets_;  // the first is lcm.url
};

}  // namespace roundel
