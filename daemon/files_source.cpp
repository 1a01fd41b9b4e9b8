#include "daemon/files_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "daemon/log.hpp"
#include "transport/clock.hpp"

namespace roundel {
namespace {

constexpr std::int64_t kMostLogged = 10;  // unreadable frames; more are only counted

}  // namespace

FilesSource::FilesSource(const FilesParameters& parameters)
    : parameters_(parameters), recording_(parameters.paths) {
  if (!recording_.next(image_)) {
    throw std::runtime_error(fmt::format("{}: has no frames", recording_.first_file()));
  }
  due_ns_ = monotonic_ns();
  timer_.arm(due_ns_);
}

std::optional<FrameLease> FilesSource::next() {
  if (!timer_.take() || state_ == CameraState::kEnded) return std::nullopt;
  if (!image_is_new_ && !read_next()) {
    state_ = CameraState::kEnded;
    return std::nullopt;
  }
  image_is_new_ = false;
  state_ = CameraState::kStreaming;
  const std::int64_t current_ns = monotonic_ns();
  if (parameters_.frame_rate > 0) {
    // Never faster than the rate, also not to make up for being late.
    const auto period_ns = static_cast<std::int64_t>(1e9 / parameters_.frame_rate);
    due_ns_ = std::max(due_ns_ + period_ns, current_ns);
  }
  timer_.arm(due_ns_);
  const TimeStamp arrived = now();
  return FrameLease(
      *this, 0, {image_.view(), next_number_++, arrived, StampSource::kArrival, arrived.mono_us});
}

bool FilesSource::read_next() {
  for (;;) {
    try {
      if (recording_.next(image_)) {
        any_since_rewind_ = true;
        return true;
      }
      if (!parameters_.loop || !any_since_rewind_) return false;
      recording_.rewind();
      any_since_rewind_ = false;
    } catch (const std::runtime_error& error) {
      ++unreadable_;
      ++next_number_;
      if (unreadable_ <= kMostLogged) log_error("{}; goes on behind it", error.what());
    }
  }
}

std::string FilesSource::description() const {
  const std::string rate = parameters_.frame_rate > 0
                               ? fmt::format("at {} frames/s", parameters_.frame_rate)
                               : std::string("as fast as possible");
  const std::string more = recording_.file_count() > 1
                               ? fmt::format(" and {} more", recording_.file_count() - 1)
                               : std::string();
  return fmt::format("files {}{}, {}x{} {}", recording_.first_file(), more, width(), height(),
                     rate);
}

}  // namespace roundel
