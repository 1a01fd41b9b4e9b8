// The tracker reads the driver's own memory.
#include <doctest/doctest.h>
#include <fmt/format.h>
#include <linux/videodev2.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <sstream>

#include "core/tracker.hpp"
#include "daemon/broadcast.hpp"
#include "daemon/capture/camera_source.hpp"
#include "daemon/latency_histogram.hpp"
#include "tests/allocation_counter.hpp"
#include "tests/daemon/wait_for_descriptor.hpp"
#include "tests/lab/report.hpp"
#include "tests/lab/usb_camera.hpp"
#include "tests/lab/vivid_camera.hpp"

using namespace roundel;

namespace {

constexpr int kPatienceMs = 20'000;
constexpr int kFrames = 30;

// The mappings of the camera's memory in this process, in the kernel's own words.
class CameraMappings {
 public:
  CameraMappings() {
    std::ifstream maps("/proc/self/maps");
    for (std::string line; std::getline(maps, line);) {
      if (!line.ends_with("/dev/video0")) continue;
      std::istringstream words(line);
      Range& range = ranges_.emplace_back();
      char dash = 0;
      words >> std::hex >> range.begin >> dash >> range.end;
    }
  }

  // Whether all of a picture lies in one of them.
  bool hold(const LumaView& luma) const {
    const auto first = reinterpret_cast<std::uintptr_t>(luma.data);
    const auto last = reinterpret_cast<std::uintptr_t>(
        &luma.row(luma.height - 1)[(luma.width - 1) * luma.pixel_stride]);
    return std::any_of(ranges_.begin(), ranges_.end(), [&](const Range& range) {
      return first >= range.begin && last < range.end;
    });
  }

 private:
  struct Range {
    std::uintptr_t begin = 0, end = 0;
  };
  std::vector<Range> ranges_;
};

bool same_pixels(const LumaView& luma, const GreyImage& picture) {
  if (luma.width != picture.width || luma.height != picture.height) return false;
  for (int v = 0; v < luma.height; ++v) {
    const std::uint8_t* const expected = picture.view().row(v);
    if (luma.pixel_stride == 1) {
      if (std::memcmp(luma.row(v), expected, static_cast<std::size_t>(luma.width)) != 0)
        return false;
      continue;
    }
    for (int u = 0; u < luma.width; ++u) {
      if (luma.at(u, v) != expected[u]) return false;
    }
  }
  return true;
}

// Whether it is, to the pixel, one of the film's pictures.
bool is_of_film(const LumaView& luma, const Film& film) {
  for (int i = 0; i < film.pictures(); ++i) {
    if (same_pixels(luma, film.picture(i))) return true;
  }
  return false;
}

std::optional<FrameLease> wait_for_frame(CameraSource& source) {
  for (int i = 0; i < 1000; ++i) {
    if (!wait_for_descriptor(source.descriptor(), kPatienceMs)) return std::nullopt;
    if (std::optional<FrameLease> lease = source.next()) return lease;
  }
  return std::nullopt;
}

// Tracks and publishes frames of a camera as roundeld does, in this process. Returns how often
// memory was allocated on the way.
long check_in_place(const std::string& name, const CameraParameters& parameters, const Film& film,
                    bool shows_film) {
  CAPTURE(name);
  CameraSource source(parameters);
  Tracker tracker(DetectorParameters{}, film.camera());
  LcmSettings lcm;
  Broadcast broadcast(lcm, "lab");
  LatencyHistogram dequeue_to_publish;
  std::optional<CameraMappings> mappings;  // there are some when the stream has been started
  long allocations = 0;
  const auto carry = [&](bool count) {
    std::optional<FrameLease> lease = wait_for_frame(source);
    REQUIRE(lease.has_value());
    const LumaView& luma = lease->frame().luma;
    if (!mappings) mappings.emplace();
    CHECK(mappings->hold(luma));
    if (shows_film && !count) CHECK(is_of_film(luma, film));
    const AllocationCounter counter;
    const std::span<const Marker> markers = tracker.track(luma);
    lease->give_back();
    FrameInformation information;
    information.captured = lease->frame().captured;
    broadcast.publish(information, markers);
    if (count) {
      allocations += counter.count();
      dequeue_to_publish.add(now().mono_us - lease->frame().arrived_us);
    }
  };
  // Every picture of the film, forward and backward: then all memory has grown.
  for (int i = 0; i < (shows_film ? film.period() : kFrames); ++i) carry(false);
  for (int i = 0; i < kFrames; ++i) carry(true);
  report(
      fmt::format("{}: read in place; dequeue to publish 50 % {:.0f} us, 90 % {:.0f} us, 99 % "
                  "{:.0f} us",
                  name, dequeue_to_publish.percentile_us(0.5),
                  dequeue_to_publish.percentile_us(0.9), dequeue_to_publish.percentile_us(0.99)));
  return allocations;
}

}  // namespace

TEST_CASE(
    "direct formats arrive to the pixel, are read in the driver's own memory, allocate nothing") {
  const Film& film = Film::shared();
  struct Case {
    const char* name;
    UsbFormat format;
  };
  for (const Case& c : {Case{"GREY", UsbFormat::kGrey}, Case{"YUYV", UsbFormat::kYuyv},
                        Case{"NV12", UsbFormat::kNv12}}) {
    UsbCameraDescription description;
    description.formats = {c.format};
    const UsbCamera camera(film, description);
    CHECK(check_in_place(c.name, CameraParameters(), film, true) == 0);
  }
}

// They show vivid's own pattern, whatever the tracker makes of it.
TEST_CASE("multi-planar buffers are read in the driver's own memory") {
  const Film& film = Film::shared();
  VividCamera camera(film, V4L2_PIX_FMT_GREY, "multiplanar=2");
  CameraParameters parameters;
  parameters.choice.card = "vivid";
  parameters.mode.width = 640;
  parameters.mode.height = 480;
  for (const std::uint32_t fourcc : {V4L2_PIX_FMT_GREY, V4L2_PIX_FMT_NV12M, V4L2_PIX_FMT_NV12}) {
    parameters.mode.fourcc = fourcc;
    check_in_place(fourcc_name(fourcc) + " by several planes", parameters, film, false);
  }
}
