#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/grey_image.hpp"
#include "daemon/image_file.hpp"
#include "daemon/y4m.hpp"

namespace roundel {

// Frames one after another from the files of a command line: images, .y4m video, or "-" for y4m on
// standard input, in the order given.
class FrameInput {
 public:
  explicit FrameInput(std::vector<std::string> files);

  // True if there may be more than one frame.
  bool is_sequence() const;

  // The next frame; false after the last. Throws std::runtime_error that names file and frame.
  bool next(GreyImage& frame);

  // Of the frame read last: its file as given, its number from 0 over all files, and its time since
  // the start of the video (0 for images); what was recorded by `roundel record` has the number and
  // the time of its capture.
  const std::string& source() const { return files_[file_]; }
  std::int64_t frame() const { return frame_; }
  std::int64_t utime() const { return utime_; }
  bool from_video() const { return from_video_; }

 private:
  std::vector<std::string> files_;
  std::size_t next_file_ = 0, file_ = 0;
  std::int64_t frame_ = -1, utime_ = 0;
  bool from_video_ = false;
  ImageLoader loader_;
  std::unique_ptr<Y4mReader> video_;  // the one being read, if any
};

}  // namespace roundel
