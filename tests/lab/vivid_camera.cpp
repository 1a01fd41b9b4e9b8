#include "tests/lab/vivid_camera.hpp"

#include <fcntl.h>
#include <linux/v4l2-dv-timings.h>
#include <linux/videodev2.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <span>
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

// Setting them is a change of the source for the camera, also if they stay.
void set_timings(int device) {
  v4l2_dv_timings timings{};
  if (::ioctl(device, VIDIOC_G_DV_TIMINGS, &timings) == 0 && timings.bt.width == 640) return;
  timings = V4L2_DV_BT_CEA_640X480P59_94;
  ::ioctl(device, VIDIOC_S_DV_TIMINGS, &timings);
}

// The same.
void set_format(int device, std::uint32_t fourcc) {
  v4l2_format format{};
  format.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
  ::ioctl(device, VIDIOC_G_FMT, &format);
  v4l2_pix_format& pixels = format.fmt.pix;
  if (pixels.pixelformat == fourcc && pixels.width == 640 && pixels.height == 480) return;
  pixels.pixelformat = fourcc;
  pixels.width = 640;
  pixels.height = 480;
  pixels.field = V4L2_FIELD_NONE;
  pixels.bytesperline = 0;
  ::ioctl(device, VIDIOC_S_FMT, &format);
}

// The driver's output: takes pictures into its buffers.
class OutputStream {
 public:
  OutputStream(const std::string& node, std::uint32_t fourcc)
      : device_(::open(node.c_str(), O_RDWR | O_CLOEXEC)) {
    set_timings(device_.get());
    set_format(device_.get(), fourcc);
    v4l2_requestbuffers request{};
    request.count = 4;
    request.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
    request.memory = V4L2_MEMORY_MMAP;
    if (::ioctl(device_.get(), VIDIOC_REQBUFS, &request) != 0) return;
    for (std::uint32_t index = 0; index < request.count; ++index) {
      v4l2_buffer buffer = buffer_of(index);
      if (::ioctl(device_.get(), VIDIOC_QUERYBUF, &buffer) != 0) return;
      void* const address = ::mmap(nullptr, buffer.length, PROT_READ | PROT_WRITE, MAP_SHARED,
                                   device_.get(), buffer.m.offset);
      if (address == MAP_FAILED) return;
      buffers_.emplace_back(static_cast<std::uint8_t*>(address), buffer.length);
    }
  }
  ~OutputStream() {
    for (const auto& buffer : buffers_) ::munmap(buffer.data(), buffer.size());
  }
  OutputStream(const OutputStream&) = delete;
  OutputStream& operator=(const OutputStream&) = delete;

  // False if the device does not take it.
  bool show(const std::vector<std::uint8_t>& picture) {
    v4l2_buffer buffer = buffer_of(filled_);
    if (filled_ < buffers_.size()) {
      ++filled_;
    } else if (buffers_.empty() || ::ioctl(device_.get(), VIDIOC_DQBUF, &buffer) != 0) {
      return false;
    }
    const std::span<std::uint8_t> memory = buffers_[buffer.index];
    std::memcpy(memory.data(), picture.data(), std::min(memory.size(), picture.size()));
    buffer.bytesused = static_cast<std::uint32_t>(memory.size());
    buffer.field = V4L2_FIELD_NONE;
    if (::ioctl(device_.get(), VIDIOC_QBUF, &buffer) != 0) return false;
    int type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
    return filled_ != 2 || ::ioctl(device_.get(), VIDIOC_STREAMON, &type) == 0;
  }

 private:
  static v4l2_buffer buffer_of(std::uint32_t index) {
    v4l2_buffer buffer{};
    buffer.index = index;
    buffer.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
    buffer.memory = V4L2_MEMORY_MMAP;
    return buffer;
  }

  UniqueFd device_;
  std::vector<std::span<std::uint8_t>> buffers_;
  std::uint32_t filled_ = 0;  // for the first time
};

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
    OutputStream output(output_, fourcc_);
    std::int64_t due_us = now().mono_us;
    while (!stop_ && output.show(pictures[static_cast<std::size_t>(film_.shown(shown++))])) {
      due_us += kPeriodUs;
      const std::int64_t left_us = due_us - now().mono_us;
      if (left_us > 0) ::usleep(static_cast<useconds_t>(left_us));
    }
    ::usleep(20'000);
  }
}

}  // namespace roundel
