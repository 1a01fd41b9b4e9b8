#include "daemon/control/event_feed.hpp"

#include <algorithm>

namespace roundel {

class EventFeed::Listener final : public HttpStream {
 public:
  explicit Listener(EventFeed& feed) : feed_(feed) { ++feed_.listeners_; }
  ~Listener() override { --feed_.listeners_; }

  std::size_t read(char* out, std::size_t room) override {
    if (!text_ || sent_ == text_->size()) {
      const std::lock_guard lock(feed_.mutex_);
      if (feed_.number_ == seen_) return 0;
      seen_ = feed_.number_;
      text_ = feed_.newest_;
      sent_ = 0;
    }
    const std::size_t size = text_->copy(out, room, sent_);
    sent_ += size;
    return size;
  }

 private:
  EventFeed& feed_;
  std::uint64_t seen_ = 0;
  std::shared_ptr<const std::string> text_;
  std::size_t sent_ = 0;
};

void EventFeed::offer(std::shared_ptr<const std::string> event) {
  const std::lock_guard lock(mutex_);
  newest_ = std::move(event);
  ++number_;
}

std::unique_ptr<HttpStream> EventFeed::listen() {
  return std::make_unique<Listener>(*this);
}

}  // namespace roundel
