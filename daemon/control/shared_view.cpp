#include "daemon/control/shared_view.hpp"

namespace roundel {

void SharedView::show(std::shared_ptr<const FrameSnapshot> frame) {
  {
    const std::lock_guard lock(mutex_);
    if (frame->has_picture) {
      picture_ = frame;
      ++pictures_;
    }
    frame_ = std::move(frame);
  }
  news_.notify_all();
}

void SharedView::show(const status_t& status) {
  const std::lock_guard lock(mutex_);
  status_ = status;
}

std::shared_ptr<const FrameSnapshot> SharedView::frame() const {
  const std::lock_guard lock(mutex_);
  return frame_;
}

status_t SharedView::status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}

std::shared_ptr<const FrameSnapshot> SharedView::next_picture(std::chrono::milliseconds timeout) {
  ++wanting_;
  std::shared_ptr<const FrameSnapshot> result;
  {
    std::unique_lock lock(mutex_);
    const std::uint64_t seen = pictures_;
    if (news_.wait_for(lock, timeout, [&] { return closed_ || pictures_ != seen; }) && !closed_) {
      result = picture_;
    }
    // Of several who wait, each gets it; the last does not keep it.
    if (--wanting_ == 0) picture_.reset();
  }
  return result;
}

void SharedView::close() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  news_.notify_all();
}

}  // namespace roundel
