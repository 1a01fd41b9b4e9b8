#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "core/luma_view.hpp"
#include "daemon/y4m.hpp"

namespace roundel {

// Where made frames go: y4m video (FILE.y4m, or "-" for standard output), or one PNG a frame in a
// directory (frame_000000.png and on). Errors are std::runtime_error that names the file.
class FrameOutput {
 public:
  // A path that is neither is a UsageError. Makes the directory.
  FrameOutput(const std::string& path, int width, int height, double frames_per_second);

  void write(const LumaView& frame);
  void close();

 private:
  std::string directory_;
  std::unique_ptr<Y4mWriter> video_;  // none: pictures
  std::int64_t frames_ = 0;
};

}  // namespace roundel
