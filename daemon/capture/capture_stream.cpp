#include "daemon/capture/capture_stream.hpp"

#include <fmt/format.h>
#include <linux/videodev2.h>

#include <algorithm>
#include <array>
#include <cerrno>

namespace roundel {
namespace {

// Drivers may say anything; what is no time at all becomes one that nobody believes.
std::int64_t microseconds(const timeval& time) {
  constexpr std::int64_t kSecond = 1'000'000, kMostSeconds = INT64_MAX / kSecond - 1, kNoTime = -1;
  const auto seconds = std::int64_t{time.tv_sec}, rest = std::int64_t{time.tv_usec};
  if (seconds < 0 || seconds > kMostSeconds || rest < 0 || rest >= kSecond) return kNoTime;
  return seconds * kSecond + rest;
}

}  // namespace

// With one plane or several, what is needed of a v4l2_buffer is in other places.
struct CaptureStream::Exchange {
  explicit Exchange(std::uint32_t type) : multiplanar(type == V4L2_BUF_TYPE_VIDEO_CAPTURE_MPLANE) {
    buffer.type = type;
    buffer.memory = V4L2_MEMORY_MMAP;
    if (multiplanar) {
      buffer.m.planes = planes.data();
      buffer.length = VIDEO_MAX_PLANES;
    }
  }
  Exchange(const Exchange&) = delete;
  Exchange& operator=(const Exchange&) = delete;

  std::uint32_t length() const { return multiplanar ? planes[0].length : buffer.length; }
  std::uint32_t map_offset() const {
    return multiplanar ? planes[0].m.mem_offset : buffer.m.offset;
  }
  std::uint32_t bytes_used() const { return multiplanar ? planes[0].bytesused : buffer.bytesused; }
  std::uint32_t data_offset() const { return multiplanar ? planes[0].data_offset : 0; }

  bool multiplanar;
  v4l2_buffer buffer{};
  std::array<v4l2_plane, VIDEO_MAX_PLANES> planes{};
};

CaptureStream::CaptureStream(VideoDevice& device, bool multiplanar, int buffers)
    : device_(device),
      type_(multiplanar ? V4L2_BUF_TYPE_VIDEO_CAPTURE_MPLANE : V4L2_BUF_TYPE_VIDEO_CAPTURE) {
  try {
    request_buffers(buffers);
    for (std::size_t i = 0; i < buffers_.size(); ++i) {
      map_buffer(static_cast<std::uint32_t>(i));
      if (!queue(static_cast<int>(i))) throw CameraError("a new buffer was refused by its driver");
    }
    device_.require(VIDIOC_STREAMON, &type_, "the stream can't be started");
  } catch (...) {
    release();
    throw;
  }
}

CaptureStream::~CaptureStream() {
  device_.control(VIDIOC_STREAMOFF, &type_);
  release();
}

// Asking for no buffers first tells what the driver can do. Cached buffers need no care of ours:
// the kernel synchronises them when they are queued and dequeued, as long as no hint tells it not
// to.
void CaptureStream::request_buffers(int count) {
  v4l2_requestbuffers request{};
  request.type = type_;
  request.memory = V4L2_MEMORY_MMAP;
  const bool hints = device_.control(VIDIOC_REQBUFS, &request) == 0 &&
                     (request.capabilities & V4L2_BUF_CAP_SUPPORTS_MMAP_CACHE_HINTS) != 0;
  request = {};
  request.type = type_;
  request.memory = V4L2_MEMORY_MMAP;
  request.count = static_cast<std::uint32_t>(count);
  if (hints) request.flags = V4L2_MEMORY_FLAG_NON_COHERENT;
  device_.require(VIDIOC_REQBUFS, &request, "it gives no buffers");
  cached_ = (request.flags & V4L2_MEMORY_FLAG_NON_COHERENT) != 0;
  // One is read while the driver fills another.
  if (request.count < 2 || request.count > VIDEO_MAX_FRAME) {
    throw CameraError(fmt::format("its driver gives {} buffers", request.count));
  }
  buffers_.resize(request.count);
  returned_.reserve(request.count);
}

void CaptureStream::map_buffer(std::uint32_t index) {
  Exchange exchange(type_);
  exchange.buffer.index = index;
  device_.require(VIDIOC_QUERYBUF, &exchange.buffer, "a buffer can't be looked at");
  const std::size_t length = exchange.length();
  void* const address =
      length == 0 ? nullptr : device_.map(length, std::int64_t{exchange.map_offset()});
  if (address == nullptr) throw CameraError("a buffer can't be mapped");
  buffers_[index].memory = {static_cast<const std::uint8_t*>(address), length};
}

void CaptureStream::release() {
  for (Buffer& buffer : buffers_) {
    if (buffer.memory.empty()) continue;
    device_.unmap(const_cast<std::uint8_t*>(buffer.memory.data()), buffer.memory.size());
  }
  buffers_.clear();
  v4l2_requestbuffers none{};
  none.type = type_;
  none.memory = V4L2_MEMORY_MMAP;
  device_.control(VIDIOC_REQBUFS, &none);
}

std::optional<FilledBuffer> CaptureStream::dequeue() {
  queue_returned();
  Exchange exchange(type_);
  const int error = device_.control(VIDIOC_DQBUF, &exchange.buffer);
  if (error == EAGAIN) return std::nullopt;
  if (error != 0) throw CameraError(reason_of(error));
  const std::uint32_t index = exchange.buffer.index;
  if (index >= buffers_.size() || !buffers_[index].queued) {
    throw CameraError(fmt::format("its driver returned buffer {}, which it did not have", index));
  }
  buffers_[index].queued = false;

  FilledBuffer filled;
  filled.index = static_cast<int>(index);
  filled.sequence = exchange.buffer.sequence;
  filled.stamp.mono_us = microseconds(exchange.buffer.timestamp);
  filled.stamp.flags = exchange.buffer.flags;
  const std::size_t begin = exchange.data_offset(), end = exchange.bytes_used();
  const std::span<const std::uint8_t> memory = buffers_[index].memory;
  if ((exchange.buffer.flags & V4L2_BUF_FLAG_ERROR) == 0 && begin < end && end <= memory.size()) {
    filled.bytes = memory.subspan(begin, end - begin);
  }
  return filled;
}

void CaptureStream::give_back(int index) {
  if (!queue(index)) returned_.push_back(index);
}

void CaptureStream::queue_returned() {
  std::erase_if(returned_, [&](int index) { return queue(index); });
}

bool CaptureStream::queue(int index) {
  Exchange exchange(type_);
  exchange.buffer.index = static_cast<std::uint32_t>(index);
  const bool taken = device_.control(VIDIOC_QBUF, &exchange.buffer) == 0;
  if (taken) buffers_[static_cast<std::size_t>(index)].queued = true;
  return taken;
}

}  // namespace roundel
