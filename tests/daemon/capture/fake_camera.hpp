#pragma once

#include <linux/videodev2.h>

#include <cerrno>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "calibration/unique_fd.hpp"
#include "daemon/capture/video_device.hpp"

namespace roundel {

// A camera without a kernel, and its driver, which can be as wrong as a test wants it. One camera;
// it may be opened several times, but only one stream.
class FakeCamera final : public CameraSystem {
 public:
  FakeCamera();

  std::vector<CameraInformation> cameras() const override;
  std::unique_ptr<VideoDevice> open(const std::string& node) const override;
  std::unique_ptr<VideoDevice> open_converted(const std::string& node) const override;

  // A buffer that the driver returns, in the order of these.
  struct Delivery {
    std::optional<std::uint32_t> index = {};       // nothing: the buffer queued first
    std::optional<std::uint32_t> bytes_used = {};  // nothing: all
    std::uint32_t data_offset = 0;                 // of the first of several planes
    std::uint32_t flags = 0;                       // added to a monotonic stamp of the end of frame
    std::uint32_t sequence = 0;
    std::optional<timeval> stamp = {};  // nothing: now
    bool no_clock = false;
    std::uint8_t fill = 0;  // every byte of the frame
  };
  void deliver(const Delivery& delivery);
  void break_off(int error);  // whatever is asked of the stream from now on fails
  void unplug() {
    state_->plugged = false;
    break_off(ENODEV);
  }
  void plug() {  // in again
    state_->plugged = true;
    state_->error = 0;
  }

  struct FakeControl {
    std::uint32_t id = 0;
    std::string label;
    std::uint32_t type = 0;
    std::int64_t minimum = 0, maximum = 0, value = 0;
    std::uint32_t owner = 0;  // a control that must be manual (1) before this can be set
    std::vector<std::string> menu;
    std::uint32_t flags = 0;
  };

  // The state, for tests to set and to look at.
  struct State {
    bool plugged = true, multiplanar = false;
    bool listed = true;  // among the cameras that there are
    std::vector<CameraInformation> others;
    std::vector<std::uint32_t> formats;
    std::vector<std::uint32_t> emulated;  // by libv4l2, in addition
    int width = 64, height = 48;
    std::uint32_t row_stride = 64, buffer_bytes = 64 * 48;
    v4l2_fract interval = {1, 30};        // of the frames
    std::uint32_t forced_fourcc = 0;      // what is set, whatever was asked for; 0: that
    int forced_width = 0;                 // the same
    bool endless = false;                 // lists of formats, sizes, rates and controls never end
    std::map<unsigned long, int> errors;  // of other requests than for frames, by their numbers
    bool refuse_maps = false;
    std::uint32_t buffer_count = 0;  // 0: as many as are asked for
    int busy_starts = 0;             // so many tries fail with EBUSY
    std::uint32_t capabilities = 0;  // of the buffers
    bool refuse_queue = false;
    std::vector<FakeControl> controls;

    std::uint32_t set_fourcc = 0;
    std::deque<std::uint32_t> queued;
    std::deque<Delivery> deliveries;
    std::vector<std::vector<std::uint8_t>> memory;
    int error = 0;
    bool streaming = false;
    int opens = 0, starts = 0, open_now = 0, mapped_now = 0;
    std::vector<std::uint32_t> control_order;  // as they were set
    UniqueFd ready;
  };
  State& state() const { return *state_; }

 private:
  std::shared_ptr<State> state_;
};

}  // namespace roundel
