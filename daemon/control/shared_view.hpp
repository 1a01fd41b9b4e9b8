#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>

#include "daemon/control/frame_snapshot.hpp"

namespace roundel {

// What clients are shown: the newest frame and the newest status, shared by all threads besides the
// frame loop, which never comes here.
class SharedView {
 public:
  void show(std::shared_ptr<const FrameSnapshot> frame);
  void show(const status_t& status);

  std::shared_ptr<const FrameSnapshot> frame() const;  // nullptr: none has come yet
  status_t status() const;

  // A frame that comes after the call, with its picture. nullptr if none comes in time.
  std::shared_ptr<const FrameSnapshot> next_picture(std::chrono::milliseconds timeout);
  // Whether somebody waits for a picture: the frame loop copies one only then.
  bool wants_picture() const { return wanting_.load(std::memory_order_relaxed) > 0; }

  // Whoever waits is told that nothing will come.
  void close();

 private:
  mutable std::mutex mutex_;
  std::condition_variable news_;
  std::shared_ptr<const FrameSnapshot> frame_, picture_;
  std::uint64_t pictures_ = 0;
  status_t status_{};
  bool closed_ = false;
  std::atomic<int> wanting_{0};
};

}  // namespace roundel
