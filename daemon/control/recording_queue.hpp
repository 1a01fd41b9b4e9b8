#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "daemon/control/frame_snapshot.hpp"

namespace roundel {

// Frames with their pictures, on their way from the frame loop to whoever records them: one thread
// fills, one other empties, and neither waits for the other. All memory is taken beforehand. What
// the reader is too slow for is left out, and counted.
class RecordingQueue {
 public:
  struct Entry {
    FrameSnapshot frame;
    std::int64_t unrecorded = 0;  // frames that found no room, up to this one
  };

  // Room for as many frames of this size as some memory holds, at least a few.
  RecordingQueue(int width, int height);

  // The frame loop's: the place for the next frame; nullptr: there is no room (which is counted).
  // Holds an old frame. push() hands it over.
  Entry* back();
  void push();

  // The reader's: the oldest frame; nullptr: there is none. pop() gives its place back.
  const Entry* front() const;
  void pop();

  // Any thread: nobody reads any more.
  void close() { closed_.store(true, std::memory_order_release); }
  bool closed() const { return closed_.load(std::memory_order_acquire); }

  std::size_t capacity() const { return entries_.size(); }

 private:
  Entry& entry(std::uint64_t number) { return entries_[number % entries_.size()]; }

  std::vector<Entry> entries_;
  std::int64_t unrecorded_ = 0;            // the frame loop's
  std::atomic<std::uint64_t> written_{0};  // frames pushed, and popped
  std::atomic<std::uint64_t> read_{0};
  std::atomic<bool> closed_{false};
};

}  // namespace roundel
