#include <linux/videodev2.h>

#include <algorithm>

#include "daemon/capture/camera_mode.hpp"
#include "daemon/capture/driver_text.hpp"

namespace roundel {
namespace {

// A driver that never says "no more" is not followed for ever.
constexpr std::uint32_t kMost = 256;

double rate_of(const v4l2_fract& interval) {
  return interval.numerator == 0 ? 0 : double{1} * interval.denominator / interval.numerator;
}

std::vector<double> frame_rates(VideoDevice& device, std::uint32_t fourcc, int width, int height) {
  std::vector<double> rates;
  for (std::uint32_t index = 0; index < kMost; ++index) {
    v4l2_frmivalenum interval{};
    interval.index = index;
    interval.pixel_format = fourcc;
    interval.width = static_cast<std::uint32_t>(width);
    interval.height = static_cast<std::uint32_t>(height);
    if (device.control(VIDIOC_ENUM_FRAMEINTERVALS, &interval) != 0) break;
    if (interval.type != V4L2_FRMIVAL_TYPE_DISCRETE) {
      rates = {rate_of(interval.stepwise.min), rate_of(interval.stepwise.max)};
      break;
    }
    rates.push_back(rate_of(interval.discrete));
  }
  std::sort(rates.begin(), rates.end(), std::greater<>());
  return rates;
}

std::vector<OfferedSize> sizes(VideoDevice& device, std::uint32_t fourcc) {
  std::vector<OfferedSize> found;
  for (std::uint32_t index = 0; index < kMost; ++index) {
    v4l2_frmsizeenum size{};
    size.index = index;
    size.pixel_format = fourcc;
    if (device.control(VIDIOC_ENUM_FRAMESIZES, &size) != 0) break;
    if (size.type != V4L2_FRMSIZE_TYPE_DISCRETE) return {};
    OfferedSize offered;
    offered.width = static_cast<int>(std::min<std::uint32_t>(size.discrete.width, INT16_MAX));
    offered.height = static_cast<int>(std::min<std::uint32_t>(size.discrete.height, INT16_MAX));
    offered.frame_rates = frame_rates(device, fourcc, offered.width, offered.height);
    found.push_back(std::move(offered));
  }
  return found;
}

}  // namespace

double OfferedSize::fastest() const {
  return frame_rates.empty() ? 0 : frame_rates.front();
}

std::vector<OfferedFormat> offered_formats(VideoDevice& device, bool multiplanar) {
  std::vector<OfferedFormat> found;
  for (std::uint32_t index = 0; index < kMost; ++index) {
    v4l2_fmtdesc format{};
    format.index = index;
    format.type = multiplanar ? V4L2_BUF_TYPE_VIDEO_CAPTURE_MPLANE : V4L2_BUF_TYPE_VIDEO_CAPTURE;
    if (device.control(VIDIOC_ENUM_FMT, &format) != 0) break;
    OfferedFormat offered;
    offered.fourcc = format.pixelformat;
    offered.description = driver_text(format.description);
    offered.emulated = (format.flags & V4L2_FMT_FLAG_EMULATED) != 0;
    offered.sizes = sizes(device, format.pixelformat);
    found.push_back(std::move(offered));
  }
  return found;
}

}  // namespace roundel
