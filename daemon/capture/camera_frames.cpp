// The way of a frame from a camera that streams: the newest is lent, the others go back.
#include <utility>

#include "daemon/capture/camera_source.hpp"

namespace roundel {
namespace {

// A larger step in the driver's numbers is no gap but nonsense.
constexpr std::uint32_t kLargestGap = 100'000;

}  // namespace

std::optional<FrameLease> CameraSource::take_newest(bool broken) {
  CaptureStream& stream = *camera_->stream;
  counts_ += std::exchange(later_, {});
  std::optional<FilledBuffer> newest;
  std::int64_t number = 0;
  int ready = 0;
  while (ready < stream.buffers()) {
    const std::optional<FilledBuffer> buffer = stream.dequeue();
    if (!buffer) break;
    ++ready;
    const std::int64_t its_number = number_of(*buffer, later_);
    if (buffer->bytes.empty()) {
      ++later_.damaged;
      ++camera_->damaged;
      stream.give_back(buffer->index);
      continue;
    }
    if (newest) {
      ++later_.newer;
      stream.give_back(newest->index);
    }
    counts_ += std::exchange(later_, {});
    newest = buffer;
    number = its_number;
  }
  if (broken && ready == 0) throw CameraError("its stream broke off");
  if (!newest) return std::nullopt;
  return lend(*newest, number, ready == stream.buffers());
}

// Gaps in the driver's numbers become gaps in ours. Numbers that stand still or go back are no gap.
std::int64_t CameraSource::number_of(const FilledBuffer& buffer, DropCounts& drops) {
  if (camera_->sequence) {
    const std::uint32_t step = buffer.sequence - *camera_->sequence;  // modulo 2^32, as it wraps
    if (step > 1 && step <= kLargestGap) {
      drops.lost += step - 1;
      next_number_ += step - 1;
    }
  }
  camera_->sequence = buffer.sequence;
  return next_number_++;
}

// overrun: the driver had filled all its buffers, and nobody knows how long ago unless its stamps
// can be trusted.
std::optional<FrameLease> CameraSource::lend(const FilledBuffer& buffer, std::int64_t number,
                                             bool overrun) {
  const TimeStamp arrived = now();
  const std::optional<CaptureTime> time = camera_->clock.judge(buffer.stamp, arrived);
  if (!time || (overrun && !camera_->clock.trusted())) {
    ++counts_.stale;
    camera_->last_frame_ns = monotonic_ns();  // not the camera's fault
    camera_->stream->give_back(buffer.index);
    return std::nullopt;
  }
  const std::optional<LumaView> luma = camera_->reader.read(buffer.bytes);
  const bool in_use = luma && camera_->reader.in_place();
  if (!in_use) camera_->stream->give_back(buffer.index);
  if (!luma) {
    ++counts_.damaged;
    ++camera_->damaged;
    return std::nullopt;
  }
  note_frame();
  constexpr int kNone = -1;
  return FrameLease(*this, in_use ? buffer.index : kNone,
                    {*luma, number, time->captured, time->source, arrived.mono_us});
}

void CameraSource::give_back(int buffer) {
  if (buffer >= 0) camera_->stream->give_back(buffer);
}

}  // namespace roundel
