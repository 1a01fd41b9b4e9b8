#pragma once

#include <array>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "calibration/unique_fd.hpp"
#include "tests/lab/film.hpp"
#include "tests/lab/usb_descriptors.hpp"

namespace roundel {

// A camera that exists only as bytes: it speaks USB/IP to the kernel's vhci_hcd over a socket, and
// the kernel's own uvcvideo driver makes a real /dev/videoN of it. Shows a film.
class UsbCamera {
 public:
  // What may go wrong with the next frame.
  enum class Damage : std::uint8_t { kNone, kErrorBit, kShort, kStall, kCorrupt };

  // Plugs it in. port: of the virtual hub, one a camera. The film must outlive it.
  UsbCamera(const Film& film, UsbCameraDescription description, int port = 0);
  ~UsbCamera();
  UsbCamera(const UsbCamera&) = delete;
  UsbCamera& operator=(const UsbCamera&) = delete;

  void unplug();
  void plug();
  void damage_next(Damage damage);
  void pause(bool paused);  // streams on without sending frames

  std::int64_t frames_sent() const { return frames_sent_; }
  // When the picture was sent last, CLOCK_MONOTONIC, microseconds; 0: never.
  std::int64_t sent_us(int picture) const {
    return sent_us_[static_cast<std::size_t>(picture)].load();
  }
  // Of the exposure controls, as they are set now.
  int exposure_mode() const { return exposure_mode_; }
  std::int64_t exposure_time() const { return exposure_time_; }
  int exposure_priority() const { return exposure_priority_; }

 private:
  struct Transfer {
    std::uint32_t sequence, length;
  };
  struct Setup {
    int type, request, value, index, length;
  };

  void run();
  void perform(const std::function<void()>& action);
  void serve_socket();
  void submit(const std::array<std::uint32_t, 12>& header);
  void unlink(const std::array<std::uint32_t, 12>& header);
  void control(std::uint32_t sequence, const Setup& setup, const UsbBytes& data);
  std::optional<UsbBytes> standard_request(const Setup& setup);
  std::optional<UsbBytes> exposure_request(const Setup& setup, const UsbBytes& data);
  std::optional<UsbBytes> stream_request(const Setup& setup, const UsbBytes& data);
  void negotiate(UsbBytes& block) const;
  void attach();
  void detach();
  void reply(std::uint32_t sequence, int status, std::span<const std::uint8_t> data,
             std::uint32_t actual);
  void send_due();
  void send_payload();
  int timeout_ms() const;

  const Film& film_;
  UsbCameraDescription description_;
  int port_;
  std::vector<std::vector<UsbBytes>> pictures_;  // by format, then picture
  std::vector<std::atomic<std::int64_t>> sent_us_;

  // All below is the thread's own, but for what is atomic.
  UniqueFd socket_;
  std::deque<Transfer> transfers_;
  UsbBytes probe_, commit_;
  bool streaming_ = false;
  std::int64_t due_us_ = 0;
  std::int64_t shown_ = 0;  // frames of the film so far
  bool frame_id_ = false;
  const UsbBytes* current_ = nullptr;  // being sent
  std::size_t sent_bytes_ = 0, end_bytes_ = 0;
  Damage damage_ = Damage::kNone;
  UsbBytes payload_, corrupt_;
  std::atomic<bool> paused_ = false;
  std::atomic<std::int64_t> frames_sent_ = 0;
  std::atomic<int> exposure_mode_ = 8, exposure_priority_ = 1;
  std::atomic<std::int64_t> exposure_time_ = 333;

  std::mutex mutex_;
  std::condition_variable done_;
  std::function<void()> action_;  // for the thread to do
  bool stop_ = false;
  UniqueFd wake_;
  std::thread thread_;
};

}  // namespace roundel
