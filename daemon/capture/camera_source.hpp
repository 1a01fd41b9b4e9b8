#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "calibration/unique_fd.hpp"
#include "daemon/capture/camera_controls.hpp"
#include "daemon/capture/camera_information.hpp"
#include "daemon/capture/camera_mode.hpp"
#include "daemon/capture/capture_stream.hpp"
#include "daemon/capture/device_watch.hpp"
#include "daemon/capture/frame_clock.hpp"
#include "daemon/frame_source.hpp"
#include "daemon/monotonic_timer.hpp"

namespace roundel {

// What the user sets.
struct CameraParameters {
  CameraChoice choice;
  ModeRequest mode;
  ControlValues controls;
  int buffers = 4;
  double timeout_s = 0.4;  // without a frame for so long (or four frames' time) it is lost
};

// A V4L2 camera. It need not be there yet: it is waited for, and taken back whenever it was lost,
// the same one with the same settings. What went wrong is told in the log, once.
class CameraSource final : public FrameSource {
 public:
  // Does not touch any camera yet. The system must outlive the source.
  explicit CameraSource(const CameraParameters& parameters,
                        const CameraSystem& system = kernel_cameras());

  int descriptor() const override { return poll_.get(); }
  std::optional<FrameLease> next() override;
  std::int64_t due_ns() const override {
    return camera_ ? camera_->last_frame_ns + patience_ns() : retry_ns_;
  }
  CameraState state() const override { return state_; }
  std::string_view waits_because() const override { return reason_; }
  DropCounts drops() const override { return counts_; }
  int width() const override { return camera_ ? camera_->reader.width() : 0; }
  int height() const override { return camera_ ? camera_->reader.height() : 0; }
  bool simulated() const override { return false; }
  std::string description() const override;
  // By the serial number, or where it has none by the place where it is plugged in.
  std::string identity() const override;
  std::string crop() const override;
  std::shared_ptr<CameraControls> controls() const override { return controls_; }
  // Chosen by the same rules, it is the same camera; controls that were set while it ran stay set
  // as long as the configuration's are the same.
  void follow(const FrameSource& before) override;

 private:
  // Everything that is thrown away with a lost camera; what is set up later goes first.
  struct OpenCamera {
    CameraInformation information;
    std::unique_ptr<VideoDevice> device;
    CameraMode mode;
    LumaReader reader;
    std::unique_ptr<CaptureStream> stream;
    FrameClock clock;
    std::optional<std::uint32_t> sequence;  // of the last buffer
    std::int64_t last_frame_ns = 0;         // or of the start of the stream
    std::int64_t damaged = 0;               // frames since then
    bool any_frame = false;
  };

  void try_to_open();
  OpenCamera open_camera(const CameraInformation& information);
  bool can_be_read(VideoDevice& device, bool multiplanar) const;
  void watch_stream();
  void note_failure(const CameraError& error);
  void lose(const std::string& reason);
  void retry_at(std::int64_t instant_ns);
  void schedule_retry();
  bool format_changed();
  void check_silence();
  std::int64_t patience_ns() const;
  void note_frame();

  std::optional<FrameLease> take_newest(bool broken);
  std::int64_t number_of(const FilledBuffer& buffer, DropCounts& drops);
  std::optional<FrameLease> lend(const FilledBuffer& buffer, std::int64_t number, bool overrun);
  void give_back(int buffer) override;

  CameraParameters parameters_;
  const CameraSystem& system_;
  std::shared_ptr<CameraControls> controls_;
  UniqueFd poll_;  // of the three below, and the camera
  DeviceWatch watch_;
  MonotonicTimer timer_;  // while streaming: silence; else: the next try
  std::optional<OpenCamera> camera_;
  std::optional<CameraInformation> before_;  // the camera that gave the last frame
  CameraState state_ = CameraState::kStarting;
  std::int64_t retry_ns_ = 0;  // without a camera: of the next try
  std::int64_t pause_ns_ = 0;
  std::string reason_;         // of the last failure; empty after a frame
  std::string told_;           // the last reason in the log; empty after a frame
  bool told_in_vain_ = false;  // that the camera is there, but can't be used
  std::vector<std::string> told_remarks_;
  std::int64_t next_number_ = 0;  // of the next buffer
  DropCounts counts_;             // up to the frame that was lent last
  DropCounts later_;              // of buffers that came after it
};

}  // namespace roundel
