#pragma once

#include <cstdint>
#include <string>

#include "core/grey_image.hpp"
#include "daemon/frame_source.hpp"
#include "daemon/monotonic_timer.hpp"
#include "daemon/recording.hpp"

namespace roundel {

struct FilesParameters {
  std::vector<std::string> paths;
  double frame_rate = 0;  // frames a second at most; 0: as fast as they are taken
  bool loop = false;
};

// Recorded frames. Unlike a camera, it waits: no frame is left out however long tracking takes, so
// that a recording gives the same poses again. A frame that can't be read is named in the log and
// counted as dropped.
class FilesSource final : public FrameSource {
 public:
  // Reads the first frame. Throws std::runtime_error that names the file if it can't.
  explicit FilesSource(const FilesParameters& parameters);

  int descriptor() const override { return timer_.descriptor(); }
  std::optional<FrameLease> next() override;
  std::int64_t due_ns() const override { return due_ns_; }
  CameraState state() const override { return state_; }
  DropCounts drops() const override { return {.damaged = unreadable_}; }
  int width() const override { return image_.width; }
  int height() const override { return image_.height; }
  bool simulated() const override { return true; }
  std::string description() const override;
  bool complete() const override { return unreadable_ == 0; }

 private:
  bool read_next();

  FilesParameters parameters_;
  Recording recording_;
  GreyImage image_;
  bool image_is_new_ = true;  // read, but not yet given out
  MonotonicTimer timer_;
  CameraState state_ = CameraState::kStarting;
  std::int64_t due_ns_ = 0;
  std::int64_t next_number_ = 0;
  std::int64_t unreadable_ = 0;
  bool any_since_rewind_ = true;
};

}  // namespace roundel
