#include "tools/frame_output.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <stdexcept>

#include "daemon/image_file.hpp"
#include "tools/commands.hpp"

namespace roundel {

FrameOutput::FrameOutput(const std::string& path, int width, int height, double frames_per_second) {
  if (path == "-" || path.ends_with(".y4m")) {
    video_ = std::make_unique<Y4mWriter>(path, width, height, frames_per_second);
    return;
  }
  if (std::filesystem::path(path).has_extension() && !std::filesystem::is_directory(path)) {
    throw UsageError(
        fmt::format("{} is no place for frames: use FILE.y4m, - or a directory for PNG", path));
  }
  directory_ = path;
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error) {
    throw std::runtime_error(fmt::format("{} can't be created: {}", path, error.message()));
  }
}

void FrameOutput::write(const LumaView& frame) {
  if (video_) {
    video_->write(frame);
  } else {
    const std::string name = fmt::format("frame_{:06}.png", frames_);
    save_png((std::filesystem::path(directory_) / name).string(), frame);
  }
  ++frames_;
}

void FrameOutput::close() {
  if (video_) {
    video_->close();
  }
}

}  // namespace roundel
