#include "tests/lab/vivid_camera.hpp"

#include <fcntl.h>
#include <linux/v4l2-dv-timings.h>
#include <linux/videodev2.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <vector>

#include "calibration/unique_fd.hpp"
#include "daemon/capture/device_controls.hpp"
#include "daemon/capture/pixel_format.hpp"
#include "transport/clock.hpp"

namespace roundel {
namespace {

// A picture as words of so many bits, low byte first; 8: bytes.
std::vector<std::uint8_t> encode(const GreyImage& picture, int bits) {
  if (bits == 8) return picture.pixels;
  std::vector<std::uint8_t> words;
  words.reserve(2 * picture.pixels.size());
  for (const std::uint8_t luma : picture.pixels) {
    const int word = luma << (bits - 8);
    words.push_back(static_cast<std::uint8_t>(word & 0xff));
    words.push_back(static_cast<std::uint8_t>(word >> 8));
  }
  return words;
}

int bits_of(std::uint32_t fourcc) {
  switch (fourcc) {
    case V4L2_PIX_FMT_GREY:
      return 8;
    case V4L2_PIX_FMT_Y10:
      return 10;
    case V4L2_PIX_FMT_Y12:
      return 12;
    default:
      return 16;
  }
}

// The driver's node that can do one of these.
std::string node_of(std::uint32_t capabilities) {
  for (int number = 0; number < 16; ++number) {
    const std::string node = "/dev/video" + std::to_string(number);
    const UniqueFd device(::open(node.c_str(), O_RDWR | O_CLOEXEC));
    v4l2_capability capability{};
    if (!device || ::ioctl(device.get(), VIDIOC_QUERYCAP, &capability) != 0) continue;
    if (std::strcmp(reinterpret_cast<const char*>(capability.driver), "vivid") != 0) continue;
    if ((capability.device_caps & capabilities) != 0) return node;
  }
  throw std::runtime_error("vivid has no such node");
}

void set_timings(int device) {
  v4l2_dv_timings timings = V4L2_DV_BT_CEA_640X480P59_94;
  ::ioctl(device, VIDIOC_S_DV_TIMINGS, &timings);
}

}  // namespace

VividCamera::Module::Module(const std::string& options) {
  const std::string command =
      "modprobe vivid n_devs=1 node_types=0x101 num_inputs=1 input_types=0x3 num_outputs=1 "
      "output_types=0x1 " +
      options;
  if (std::system(command.c_str()) != 0) throw std::runtime_error(command + " failed");
}

VividCamera::Module::~Module() {
  // The last user may still be closing it.
  for (int attempt = 0; attempt < 50; ++attempt) {
    if (std::system("rmmod vivid 2>/dev/null") == 0) return;
    ::usleep(100'000);
  }
}

VividCamera::VividCamera(const Film& film, std::uint32_t fourcc, const std::string& options)
    : module_(options),
      film_(film),
      fourcc_(fourcc),
      camera_(node_of(V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_VIDEO_CAPTURE_MPLANE)),
      output_(node_of(V4L2_CAP_VIDEO_OUTPUT | V4L2_CAP_VIDEO_OUTPUT_MPLANE)) {
  set_up();
  thread_ = std::thread([this] { feed(); });
}

VividCamera::~VividCamera() {
  stop_ = true;
  thread_.join();
}

void VividCamera::set_up() {
  {
    const UniqueFd device(::open(camera_.c_str(), O_RDWR | O_CLOEXEC));
    set_timings(device.get());
  }
  set("timestamp_source", 1);  // start of exposure, else stamps lie in the future
  set("osd_text_mode", 2);     // no text over the picture
  set("loop_video", 1);
}

void VividCamera::set(const std::string& control, int value) const {
  const std::unique_ptr<VideoDevice> device = kernel_cameras().open(camera_);
  const int error = set_control(*device, find_control(list_controls(*device), control), value);
  if (error != 0) throw std::runtime_error(control + ": " + reason_of(error));
}

// Whatever fails, it begins again: a pretended disconnection concerns the output, too.
void VividCamera::feed() {
  constexpr std::int64_t kPeriodUs = 1'000'000 / 30;
  std::vector<std::vector<std::uint8_t>> pictures;
  for (int i = 0; i < film_.pictures(); ++i) {
    pictures.push_back(encode(film_.picture(i), bits_of(fourcc_)));
  }
  std::int64_t shown = 0;
  while (!stop_) {
    const UniqueFd device(::open(output_.c_str(), O_RDWR | O_CLOEXEC));
    set_timings(device.get());
    v4l2_format format{};
    format.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
    format.fmt.pix.width = 640;
    format.fmt.pix.height = 480;
    format.fmt.pix.pixelformat = fourcc_;
    format.fmt.pix.field = V4L2_FIELD_NONE;
    ::ioctl(device.get(), VIDIOC_S_FMT, &format);
    std::int64_t due_us = now().mono_us;
    while (!stop_) {
      const std::vector<std::uint8_t>& picture =
          pictures[static_cast<std::size_t>(film_.shown(shown++))];
      if (::write(device.get(), picture.data(), picture.size()) < 0) break;
      due_us += kPeriodUs;
      const std::int64_t left_us = due_us - now().mono_us;
      if (left_us > 0) ::usleep(static_cast<useconds_t>(left_us));
    }
    ::usleep(20'000);
  }
}

}  // namespace roundel
