#include "tests/lab/daemon_under_test.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <iterator>

#include "calibration/camera_file.hpp"
#include "transport/clock.hpp"

namespace roundel {
namespace {

constexpr const char* kUrl = "udpm://239.255.76.70:7720?ttl=0";
constexpr std::size_t kRobots = 4;

std::vector<std::string> command(const TemporaryDirectory& folder, const CameraModel& camera,
                                 std::vector<std::string> settings) {
  const std::string lens = folder.file("camera.yaml");
  write_camera_file(lens, {"lab", camera});
  settings.insert(settings.end(),
                  {"source=camera", "control.socket=" + folder.file("control.sock"),
                   "control.group=", std::string("lcm.url=") + kUrl, "camera.calibration=" + lens});
  std::vector<std::string> words = {ROUNDELD_BINARY};
  for (const std::string& setting : settings) words.insert(words.end(), {"--set", setting});
  return words;
}

}  // namespace

DaemonUnderTest::DaemonUnderTest(const Film& film, const std::vector<std::string>& settings)
    : film_(film),
      subscriber_(kUrl, "ROUNDEL"),
      process_(command(folder_, film.camera(), settings)) {}

bool DaemonUnderTest::receive(int timeout_ms, const std::function<bool()>& wanted) {
  const std::int64_t end_us = now().mono_us + std::int64_t{timeout_ms} * 1000;
  while (now().mono_us < end_us) {
    // Shorter than any loss: the subscriber keeps only the last status.
    const ReceivedFrame* const frame = subscriber_.next_frame(std::chrono::milliseconds(2));
    if (frame != nullptr) {
      Frame& mine = frames_.emplace_back();
      mine.header = frame->header;
      for (const marker_t& marker : frame->markers) {
        if (marker.id > 0) mine.seen.push_back({marker.id, marker.u, marker.v});
      }
    }
    const std::optional<status_t>& status = subscriber_.status();
    if (status && (statuses_.empty() || statuses_.back().mono != status->mono)) {
      statuses_.push_back(*status);
    }
    if (wanted()) return true;
  }
  return false;
}

void DaemonUnderTest::forget() {
  frames_.clear();
  statuses_.clear();
}

std::optional<std::int64_t> DaemonUnderTest::published_us(int camera_state,
                                                          std::int64_t after_us) const {
  for (const status_t& status : statuses_) {
    if (status.camera_state == camera_state && status.mono >= after_us) return status.mono;
  }
  return std::nullopt;
}

std::optional<std::int64_t> DaemonUnderTest::poses_us(std::int64_t after_us) const {
  for (const Frame& frame : frames_) {
    if (frame.seen.size() == kRobots && frame.header.capture_mono > after_us) {
      return frame.header.publish_mono;
    }
  }
  return std::nullopt;
}

bool DaemonUnderTest::poses_arrive(int timeout_ms) {
  const std::int64_t start_us = now().mono_us;
  return receive(timeout_ms, [&] { return poses_us(start_us).has_value(); });
}

const std::string& DaemonUnderTest::log() {
  const std::string never(1, '\0');
  process_.wait_for(never, std::chrono::milliseconds(0));
  return process_.errors();
}

bool DaemonUnderTest::has_logged(const std::string& text) {
  return receive(2000, [&] { return log().find(text) != std::string::npos; });
}

int DaemonUnderTest::descriptors() const {
  const std::string folder = fmt::format("/proc/{}/fd", process_.pid());
  return static_cast<int>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

std::string fault_in(const std::vector<DaemonUnderTest::Frame>& frames) {
  const DaemonUnderTest::Frame* before = nullptr;
  for (const DaemonUnderTest::Frame& frame : frames) {
    const header_t& header = frame.header;
    const std::int64_t age_us = header.publish_mono - header.capture_mono;
    if (header.camera_state != header_t::CAMERA_STREAMING) {
      return fmt::format("frame {} was published in camera state {}", header.frame,
                         header.camera_state);
    }
    if (age_us < 0 || age_us > 900'000) {
      return fmt::format("frame {} was published {} us after its capture", header.frame, age_us);
    }
    if (before != nullptr && header.session == before->header.session &&
        (header.frame <= before->header.frame ||
         header.capture_mono <= before->header.capture_mono)) {
      return fmt::format("frame {} follows frame {}, captured {} us later", header.frame,
                         before->header.frame, header.capture_mono - before->header.capture_mono);
    }
    before = &frame;
  }
  return {};
}

}  // namespace roundel
