#include <fmt/format.h>
#include <linux/videodev2.h>

#include <algorithm>
#include <cmath>

#include "daemon/capture/camera_mode.hpp"

namespace roundel {
namespace {

std::uint32_t buffer_type(bool multiplanar) {
  return multiplanar ? V4L2_BUF_TYPE_VIDEO_CAPTURE_MPLANE : V4L2_BUF_TYPE_VIDEO_CAPTURE;
}

// What v4l2_format says, whether with one plane or several.
struct SetFormat {
  int width, height, row_stride;
  std::uint32_t fourcc, field;
};

SetFormat read(const v4l2_format& format) {
  const auto number = [](std::uint32_t value) {
    return static_cast<int>(std::min<std::uint32_t>(value, INT32_MAX));
  };
  if (format.type == V4L2_BUF_TYPE_VIDEO_CAPTURE_MPLANE) {
    const v4l2_pix_format_mplane& pixels = format.fmt.pix_mp;
    return {number(pixels.width), number(pixels.height), number(pixels.plane_fmt[0].bytesperline),
            pixels.pixelformat, pixels.field};
  }
  const v4l2_pix_format& pixels = format.fmt.pix;
  return {number(pixels.width), number(pixels.height), number(pixels.bytesperline),
          pixels.pixelformat, pixels.field};
}

SetFormat set_format(VideoDevice& device, bool multiplanar, const ModeChoice& choice) {
  v4l2_format format{};
  format.type = buffer_type(multiplanar);
  device.require(VIDIOC_G_FMT, &format, "its format can't be read");
  const SetFormat current = read(format);
  const auto width = static_cast<std::uint32_t>(choice.width > 0 ? choice.width : current.width);
  const auto height =
      static_cast<std::uint32_t>(choice.height > 0 ? choice.height : current.height);
  // Anew, so that the driver computes strides.
  format = {};
  format.type = buffer_type(multiplanar);
  if (multiplanar) {
    format.fmt.pix_mp.width = width;
    format.fmt.pix_mp.height = height;
    format.fmt.pix_mp.pixelformat = choice.format->fourcc;
    format.fmt.pix_mp.field = V4L2_FIELD_NONE;
  } else {
    format.fmt.pix.width = width;
    format.fmt.pix.height = height;
    format.fmt.pix.pixelformat = choice.format->fourcc;
    format.fmt.pix.field = V4L2_FIELD_NONE;
  }
  device.require(VIDIOC_S_FMT, &format, "its format can't be set");
  return read(format);
}

bool set_crop(VideoDevice& device, const Crop& crop) {
  v4l2_selection selection{};
  selection.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;  // also for several planes, as the kernel wants it
  selection.target = V4L2_SEL_TGT_CROP;
  selection.r = {crop.left, crop.top, static_cast<std::uint32_t>(crop.width),
                 static_cast<std::uint32_t>(crop.height)};
  return device.control(VIDIOC_S_SELECTION, &selection) == 0 && selection.r.left == crop.left &&
         selection.r.top == crop.top &&
         selection.r.width == static_cast<std::uint32_t>(crop.width) &&
         selection.r.height == static_cast<std::uint32_t>(crop.height);
}

// A crop of former users, or a try that failed.
void reset_crop(VideoDevice& device) {
  v4l2_selection selection{};
  selection.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  selection.target = V4L2_SEL_TGT_CROP_DEFAULT;
  if (device.control(VIDIOC_G_SELECTION, &selection) != 0) return;
  selection.target = V4L2_SEL_TGT_CROP;
  selection.flags = 0;
  device.control(VIDIOC_S_SELECTION, &selection);
}

// The camera's own rate afterwards; 0 if it does not tell.
double set_frame_rate(VideoDevice& device, bool multiplanar, double frame_rate) {
  v4l2_streamparm parameters{};
  parameters.type = buffer_type(multiplanar);
  v4l2_fract& interval = parameters.parm.capture.timeperframe;
  if (frame_rate > 0) {
    interval = {1000, static_cast<std::uint32_t>(std::lround(1000 * frame_rate))};
    if (device.control(VIDIOC_S_PARM, &parameters) != 0) {
      parameters = {};
      parameters.type = buffer_type(multiplanar);
    }
  }
  if (device.control(VIDIOC_G_PARM, &parameters) != 0) return 0;
  if (interval.numerator == 0 || interval.denominator == 0) return 0;
  return double{1} * interval.denominator / interval.numerator;
}

std::string size_text(int width, int height) {
  return fmt::format("{}x{}", width, height);
}

void remark_differences(CameraMode& mode, const ModeRequest& request, const SetFormat& set) {
  if (mode.emulated) {
    mode.remarks.push_back(fmt::format(
        "its formats can't be read as they are: libv4l2 converts every frame to {}, which copies "
        "it and takes time",
        fourcc_name(set.fourcc)));
  }
  if (set.field != V4L2_FIELD_NONE && set.field != V4L2_FIELD_ANY) {
    mode.remarks.emplace_back("its frames are interlaced: moving markers will look combed");
  }
  if (mode.frame_rate > 0 && request.frame_rate > 0 &&
      std::abs(mode.frame_rate - request.frame_rate) > 0.02 * request.frame_rate) {
    mode.remarks.push_back(fmt::format("it gives {:.4g} frames/s instead of {:.4g}",
                                       mode.frame_rate, request.frame_rate));
  }
}

}  // namespace

CameraMode set_mode(VideoDevice& device, bool multiplanar, const ModeRequest& request) {
  reset_crop(device);
  const std::vector<OfferedFormat> offered = offered_formats(device, multiplanar);
  const ModeChoice choice = choose_mode(offered, request);
  CameraMode mode;
  mode.crop = request.crop;
  SetFormat set = set_format(device, multiplanar, choice);
  if (!mode.crop.empty() && set_crop(device, mode.crop)) {
    const ModeChoice cropped = {choice.format, mode.crop.width, mode.crop.height};
    const SetFormat tried = set_format(device, multiplanar, cropped);
    if (tried.width == mode.crop.width && tried.height == mode.crop.height) {
      set = tried;
      mode.crop = {};
    }
  }
  if (!mode.crop.empty()) {
    reset_crop(device);
    set = set_format(device, multiplanar, choice);
  }
  if (set.fourcc != choice.format->fourcc) {
    throw CameraError(fmt::format("asked for {}, it set {}", fourcc_name(choice.format->fourcc),
                                  fourcc_name(set.fourcc)));
  }
  const bool as_wanted = !request.crop.empty() && mode.crop.empty()
                             ? true
                             : (choice.width == 0 || set.width == choice.width) &&
                                   (choice.height == 0 || set.height == choice.height);
  if (!as_wanted) {
    throw CameraError(fmt::format("asked for frames of {}, it set {}",
                                  size_text(choice.width, choice.height),
                                  size_text(set.width, set.height)));
  }
  mode.layout = {*choice.format, set.width, set.height, set.row_stride};
  mode.frame_rate = set_frame_rate(device, multiplanar, request.frame_rate);
  for (const OfferedFormat& format : offered) {
    if (format.fourcc == set.fourcc) mode.emulated = format.emulated;
  }
  remark_differences(mode, request, set);
  return mode;
}

}  // namespace roundel
