#include "daemon/control/recording_queue.hpp"

#include <algorithm>

namespace roundel {
namespace {

// A second of Full HD at 30 frames a second: what a disk may need to think.
constexpr std::size_t kBytes = std::size_t{64} << 20;
constexpr std::size_t kLeast = 4, kMost = 128;
constexpr std::size_t kMarkers = 100;  // more of them allocate once

}  // namespace

RecordingQueue::RecordingQueue(int width, int height) {
  const std::size_t frame = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  entries_.resize(std::clamp(kBytes / std::max<std::size_t>(1, frame), kLeast, kMost));
  for (Entry& entry : entries_) {
    entry.frame.picture.resize(width, height);
    entry.frame.markers.reserve(kMarkers);
    entry.frame.arena.reserve(kMarkers);
  }
}

RecordingQueue::Entry* RecordingQueue::back() {
  const std::uint64_t written = written_.load(std::memory_order_relaxed);
  if (written - read_.load(std::memory_order_acquire) == entries_.size()) {
    ++unrecorded_;
    return nullptr;
  }
  Entry& free = entry(written);
  free.unrecorded = unrecorded_;
  return &free;
}

void RecordingQueue::push() {
  written_.fetch_add(1, std::memory_order_release);
}

const RecordingQueue::Entry* RecordingQueue::front() const {
  const std::uint64_t read = read_.load(std::memory_order_relaxed);
  if (read == written_.load(std::memory_order_acquire)) return nullptr;
  return &entries_[read % entries_.size()];
}

void RecordingQueue::pop() {
  read_.fetch_add(1, std::memory_order_release);
}

}  // namespace roundel
