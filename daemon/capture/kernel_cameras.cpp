#include <fcntl.h>
#include <fmt/format.h>
#include <libv4l2.h>
#include <linux/videodev2.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <filesystem>
#include <fstream>

#include "calibration/unique_fd.hpp"
#include "daemon/capture/driver_text.hpp"
#include "daemon/capture/video_device.hpp"

namespace roundel {
namespace {

namespace fs = std::filesystem;

const fs::path kClass = "/sys/class/video4linux";

// Non-blocking, so that taking frames never waits.
UniqueFd open_node(const std::string& node) {
  UniqueFd descriptor(::open(node.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC));
  if (descriptor) return descriptor;
  const int error = errno;
  const std::string text = fmt::format("{}: {}", node, reason_of(error));
  if (error == ENOENT || error == ENODEV || error == ENXIO) throw CameraAbsent(text);
  throw CameraError(text);
}

template <typename Call>
int uninterrupted(Call&& call) {
  for (;;) {
    if (call() >= 0) return 0;
    if (errno != EINTR) return errno;
  }
}

class KernelDevice final : public VideoDevice {
 public:
  explicit KernelDevice(const std::string& node) : descriptor_(open_node(node)) {}

  int descriptor() const override { return descriptor_.get(); }
  int control(unsigned long request, void* argument) override {
    return uninterrupted([&] { return ::ioctl(descriptor_.get(), request, argument); });
  }
  // Read-only: what the driver hands out is never written to.
  void* map(std::size_t length, std::int64_t offset) override {
    void* const address = ::mmap(nullptr, length, PROT_READ, MAP_SHARED, descriptor_.get(), offset);
    return address == MAP_FAILED ? nullptr : address;
  }
  void unmap(void* address, std::size_t length) override { ::munmap(address, length); }

 private:
  UniqueFd descriptor_;
};

// The same through libv4l2, which adds formats that it converts to, into memory of its own.
class ConvertedDevice final : public VideoDevice {
 public:
  explicit ConvertedDevice(const std::string& node) {
    UniqueFd descriptor = open_node(node);
    descriptor_ = ::v4l2_fd_open(descriptor.get(), 0);
    if (descriptor_ < 0) {
      throw CameraError(fmt::format("{}: libv4l2 can't open it: {}", node, reason_of(errno)));
    }
    descriptor.release();  // libv4l2 closes it
  }
  ~ConvertedDevice() override { ::v4l2_close(descriptor_); }
  ConvertedDevice(const ConvertedDevice&) = delete;
  ConvertedDevice& operator=(const ConvertedDevice&) = delete;

  int descriptor() const override { return descriptor_; }
  int control(unsigned long request, void* argument) override {
    return uninterrupted([&] { return ::v4l2_ioctl(descriptor_, request, argument); });
  }
  // libv4l2 maps for writing as well; it accepts nothing else.
  void* map(std::size_t length, std::int64_t offset) override {
    void* const address =
        ::v4l2_mmap(nullptr, length, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor_, offset);
    return address == MAP_FAILED ? nullptr : address;
  }
  void unmap(void* address, std::size_t length) override { ::v4l2_munmap(address, length); }

 private:
  int descriptor_ = -1;
};

std::string first_line(const fs::path& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return printable(line.substr(0, 256));
}

// The USB device is the parent of the interface that the driver sits on.
std::string serial_of(const std::string& name) {
  std::error_code error;
  const fs::path interface = fs::canonical(kClass / name / "device", error);
  return error ? std::string() : first_line(interface.parent_path() / "serial");
}

std::vector<std::string> links_to(const fs::path& node) {
  std::vector<std::string> links;
  for (const char* folder : {"/dev/v4l/by-id", "/dev/v4l/by-path"}) {
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error)) {
      std::error_code dangling;
      if (fs::canonical(entry->path(), dangling) == node) links.push_back(entry->path());
    }
  }
  std::sort(links.begin(), links.end());
  return links;
}

// The numbers of /dev/videoN.
std::vector<int> node_numbers() {
  constexpr std::string_view kPrefix = "video";
  std::vector<int> numbers;
  std::error_code error;
  for (fs::directory_iterator entry(kClass, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string name = entry->path().filename();
    int number = 0;
    if (!name.starts_with(kPrefix)) continue;
    const char* const last = name.data() + name.size();
    const auto [stop, problem] = std::from_chars(name.data() + kPrefix.size(), last, number);
    if (problem == std::errc() && stop == last) numbers.push_back(number);
  }
  std::sort(numbers.begin(), numbers.end());
  return numbers;
}

class KernelCameras final : public CameraSystem {
 public:
  std::vector<CameraInformation> cameras() const override {
    std::vector<CameraInformation> found;
    for (const int number : node_numbers()) {
      const std::string name = fmt::format("video{}", number);
      CameraInformation camera;
      camera.node = "/dev/" + name;
      camera.serial = serial_of(name);
      v4l2_capability capability{};
      try {
        if (KernelDevice(camera.node).control(VIDIOC_QUERYCAP, &capability) != 0) continue;
      } catch (const CameraAbsent&) {  // gone meanwhile
        continue;
      } catch (const CameraError& error) {
        camera.card = first_line(kClass / name / "name");
        camera.problem = error.what();
        camera.links = links_to(camera.node);
        found.push_back(std::move(camera));
        continue;
      }
      // Of the node itself: the metadata node of an USB camera can't capture pictures.
      const std::uint32_t can = (capability.capabilities & V4L2_CAP_DEVICE_CAPS) != 0
                                    ? capability.device_caps
                                    : capability.capabilities;
      if ((can & V4L2_CAP_STREAMING) == 0) continue;
      if ((can & (V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_VIDEO_CAPTURE_MPLANE)) == 0) continue;
      camera.multiplanar = (can & V4L2_CAP_VIDEO_CAPTURE) == 0;
      camera.card = driver_text(capability.card);
      camera.bus = driver_text(capability.bus_info);
      camera.driver = driver_text(capability.driver);
      camera.links = links_to(camera.node);
      found.push_back(std::move(camera));
    }
    return found;
  }
  std::unique_ptr<VideoDevice> open(const std::string& node) const override {
    return std::make_unique<KernelDevice>(node);
  }
  std::unique_ptr<VideoDevice> open_converted(const std::string& node) const override {
    return std::make_unique<ConvertedDevice>(node);
  }
};

}  // namespace

const CameraSystem& kernel_cameras() {
  static const KernelCameras cameras;
  return cameras;
}

}  // namespace roundel
