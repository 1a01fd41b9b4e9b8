#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "core/camera_model.hpp"
#include "core/luma_view.hpp"
#include "daemon/drop_counts.hpp"
#include "transport/frame_information.hpp"

namespace roundel {

// A frame where it lies, and when it was taken.
struct CapturedFrame {
  LumaView luma;
  std::int64_t number = 0;  // at its source, from 0; frames that were left out have numbers too
  TimeStamp captured;
  StampSource stamp_source = StampSource::kUnknown;
  std::int64_t arrived_us = 0;  // at its source, before any decoding; CLOCK_MONOTONIC
};

class CameraControls;
class FrameSource;

// A frame borrowed from its source: the buffer goes back when the lease ends, or earlier by
// give_back(). Not to outlive the source.
class FrameLease {
 public:
  FrameLease(FrameSource& source, int buffer, const CapturedFrame& frame)
      : source_(&source), buffer_(buffer), frame_(frame) {}
  ~FrameLease() { give_back(); }
  FrameLease(FrameLease&& other) noexcept
      : source_(std::exchange(other.source_, nullptr)),
        buffer_(other.buffer_),
        frame_(other.frame_) {}
  FrameLease(const FrameLease&) = delete;
  FrameLease& operator=(const FrameLease&) = delete;
  FrameLease& operator=(FrameLease&&) = delete;

  // Its luma must not be looked at after give_back().
  const CapturedFrame& frame() const { return frame_; }
  inline void give_back();

 private:
  FrameSource* source_;
  int buffer_;
  CapturedFrame frame_;
};

// Where frames come from. Not thread-safe.
class FrameSource {
 public:
  FrameSource() = default;
  virtual ~FrameSource() = default;
  FrameSource(const FrameSource&) = delete;
  FrameSource& operator=(const FrameSource&) = delete;

  // Readable when next() is to be called: for a frame, or because the state changes.
  virtual int descriptor() const = 0;

  // The newest frame if there is one; older ones that wait are left out and counted. Nothing: look
  // at state(). The lease before must have ended.
  virtual std::optional<FrameLease> next() = 0;

  // CLOCK_MONOTONIC, nanoseconds: if all is well, descriptor() is readable by then: for a frame,
  // for another try to reach the camera, or because the camera is lost.
  virtual std::int64_t due_ns() const = 0;

  virtual CameraState state() const = 0;
  virtual DropCounts drops() const = 0;  // frames left out since the source was made
  std::int64_t dropped() const { return drops().total(); }
  virtual int width() const = 0;  // of the frames, as far as it is known beforehand
  virtual int height() const = 0;
  virtual bool simulated() const = 0;  // no camera took these frames just now
  virtual std::string description() const = 0;

  // Why a camera gives no frames, in words, while it is waited for; empty: it is not.
  virtual std::string_view waits_because() const { return {}; }
  // What tells this camera from every other, whenever it is plugged in; empty: unknown. An arena
  // calibration belongs to it, and to the crop.
  virtual std::string identity() const { return {}; }
  // The part of the sensor that the frames show, in words; empty: all of it.
  virtual std::string crop() const { return {}; }
  // The exact lens, where the source knows it.
  virtual std::optional<CameraModel> camera() const { return std::nullopt; }
  // A camera's controls, for any thread; other sources have none.
  virtual std::shared_ptr<CameraControls> controls() const { return nullptr; }
  // Takes over what the source before this one knew and still holds, before the first next().
  virtual void follow(const FrameSource& /*before*/) {}
  // After state() is kEnded: whether everything could be read.
  virtual bool complete() const { return true; }

 private:
  friend class FrameLease;
  virtual void give_back(int /*buffer*/) {}
};

void FrameLease::give_back() {
  if (source_ != nullptr) std::exchange(source_, nullptr)->give_back(buffer_);
}

}  // namespace roundel
