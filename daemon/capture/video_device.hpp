#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>

#include "daemon/capture/camera_information.hpp"

namespace roundel {

// The camera cannot be used, or no longer: the sentence says why. It may come back.
struct CameraError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// There is no such camera at the moment.
struct CameraAbsent : CameraError {
  using CameraError::CameraError;
};

// An open camera, as the few calls that capture makes on it: the kernel's, libv4l2's, or those of a
// test that plays a broken driver. Closed when destroyed.
class VideoDevice {
 public:
  VideoDevice() = default;
  virtual ~VideoDevice() = default;
  VideoDevice(const VideoDevice&) = delete;
  VideoDevice& operator=(const VideoDevice&) = delete;

  virtual int descriptor() const = 0;  // to poll for frames
  // An ioctl. 0, or errno; interruptions by signals are hidden.
  virtual int control(unsigned long request, void* argument) = 0;
  // Maps a buffer for reading; nullptr if that is refused.
  virtual void* map(std::size_t length, std::int64_t offset) = 0;
  virtual void unmap(void* address, std::size_t length) = 0;

  // For calls that must succeed: throws CameraError, "what: reason".
  void require(unsigned long request, void* argument, const std::string& what);
};

// Where cameras are found and opened.
class CameraSystem {
 public:
  virtual ~CameraSystem() = default;
  // Those that can capture, or that can't be opened, in the order of their numbers.
  virtual std::vector<CameraInformation> cameras() const = 0;
  // Both throw CameraError.
  virtual std::unique_ptr<VideoDevice> open(const std::string& node) const = 0;
  virtual std::unique_ptr<VideoDevice> open_converted(const std::string& node) const = 0;
};

// This machine's.
const CameraSystem& kernel_cameras();

// What an errno of a camera means to its user.
std::string reason_of(int error);

}  // namespace roundel
