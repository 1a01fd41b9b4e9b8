#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "daemon/capture/luma_reader.hpp"
#include "daemon/capture/pixel_format.hpp"
#include "daemon/capture/video_device.hpp"

namespace roundel {

// What a camera offers: a format in one of its sizes.
struct OfferedSize {
  int width = 0, height = 0;
  std::vector<double> frame_rates;  // frames a second; empty: the driver does not tell
  double fastest() const;           // 0: unknown
};
struct OfferedFormat {
  std::uint32_t fourcc = 0;
  std::string description;
  bool emulated = false;           // converted by libv4l2
  std::vector<OfferedSize> sizes;  // empty: any, as far as the driver tells
};
std::vector<OfferedFormat> offered_formats(VideoDevice& device, bool multiplanar);

// What is wanted. 0: whatever suits.
struct ModeRequest {
  std::uint32_t fourcc = 0;
  int width = 0, height = 0;
  double frame_rate = 30;
  Crop crop;
};

// A format and size to be asked for. No size: the one that the camera has set.
struct ModeChoice {
  const PixelFormat* format = nullptr;
  int width = 0, height = 0;
};

// Wanted sizes and formats are kept to. Left open, the size is the largest up to Full HD in which
// the camera reaches the frame rate, the format the one that costs least among those that reach it.
// Throws CameraError, with what there is instead.
ModeChoice choose_mode(const std::vector<OfferedFormat>& offered, const ModeRequest& request);

// What the driver has set.
struct CameraMode {
  FrameLayout layout;
  Crop crop;              // left to be done while reading; empty if the camera does it
  double frame_rate = 0;  // 0: the driver does not tell
  bool emulated = false;
  std::vector<std::string> remarks;  // what is not as wanted
};

// Sets format, size, crop and frame rate, and reads them back. Throws CameraError.
CameraMode set_mode(VideoDevice& device, bool multiplanar, const ModeRequest& request);

}  // namespace roundel
