#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "daemon/capture/frame_clock.hpp"
#include "daemon/capture/video_device.hpp"

namespace roundel {

// A buffer that the driver has filled.
struct FilledBuffer {
  int index = 0;
  std::span<const std::uint8_t> bytes;  // of the first plane; empty if the driver called it damaged
  std::uint32_t sequence = 0;           // the driver's number of the frame
  DriverStamp stamp;
};

// The driver's buffers of a running stream, mapped. Invariant: each is either with the driver, or
// given out by dequeue(), or waits in returned_ to be given back.
class CaptureStream {
 public:
  // Asks for buffers and starts the stream; the format has been set. Throws CameraError.
  // The device must outlive the stream.
  CaptureStream(VideoDevice& device, bool multiplanar, int buffers);
  ~CaptureStream();
  CaptureStream(const CaptureStream&) = delete;
  CaptureStream& operator=(const CaptureStream&) = delete;

  // The oldest filled buffer; nothing if there is none yet. Whatever the driver says is checked.
  // Throws CameraError when the stream is broken.
  std::optional<FilledBuffer> dequeue();

  // Gives a buffer back to the driver. Where the driver refuses it, once more with the next
  // dequeue().
  void give_back(int index);

  int buffers() const { return static_cast<int>(buffers_.size()); }
  // Whether the driver lets the processor's cache hold frames where it needs to be asked.
  bool cached() const { return cached_; }

 private:
  struct Buffer {
    std::span<const std::uint8_t> memory;  // the mapping of the first plane
    bool queued = false;
  };
  struct Exchange;  // a v4l2_buffer with its planes

  void request_buffers(int count);
  void map_buffer(std::uint32_t index);
  bool queue(int index);
  void queue_returned();
  void release();

  VideoDevice& device_;
  std::uint32_t type_;
  bool cached_ = false;
  std::vector<Buffer> buffers_;
  std::vector<int> returned_;  // refused by the driver; reserved for all
};

}  // namespace roundel
