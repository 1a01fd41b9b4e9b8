#include "tools/frame_input.hpp"

#include <cmath>
#include <optional>
#include <utility>

namespace roundel {
namespace {

bool is_video(const std::string& file) {
  return file == "-" || file.ends_with(".y4m");
}

}  // namespace

FrameInput::FrameInput(std::vector<std::string> files) : files_(std::move(files)) {}

bool FrameInput::is_sequence() const {
  return files_.size() > 1 || is_video(files_.front());
}

bool FrameInput::next(GreyImage& frame) {
  while (true) {
    if (video_) {
      const std::int64_t number = video_->frames_read();
      if (video_->next(frame)) {
        const std::optional<Y4mStamp>& stamp = video_->stamp();
        frame_ = stamp ? stamp->number : frame_ + 1;
        utime_ = stamp ? stamp->utime
                       : std::llround(1e6 * static_cast<double>(number) /
                                      video_->format().frames_per_second());
        return true;
      }
      video_.reset();
    }
    if (next_file_ == files_.size()) {
      return false;
    }
    file_ = next_file_++;
    from_video_ = is_video(source());
    if (!from_video_) {
      loader_.load(source(), frame);
      ++frame_;
      utime_ = 0;
      return true;
    }
    video_ = std::make_unique<Y4mReader>(source());
  }
}

}  // namespace roundel
