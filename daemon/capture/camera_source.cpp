#include "daemon/capture/camera_source.hpp"

#include <fmt/format.h>
#include <linux/videodev2.h>
#include <sys/epoll.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <system_error>
#include <utility>

#include "daemon/log.hpp"

namespace roundel {
namespace {

constexpr std::int64_t kFirstPauseNs = 20'000'000;
constexpr std::int64_t kLongestPauseNs = 2'000'000'000;
// Cameras need a while for their first frame.
constexpr std::int64_t kStartPatienceNs = 3'000'000'000;
constexpr double kPatienceFrames = 4;
constexpr double kLongestPatienceS = 60;  // however slow its driver says that it is
constexpr int kMostEvents = 16;           // taken at once; a driver that never ends is not followed

bool add_to_poll(int poll, int descriptor, std::uint32_t events) {
  epoll_event event{};
  event.events = events;
  event.data.fd = descriptor;
  return ::epoll_ctl(poll, EPOLL_CTL_ADD, descriptor, &event) == 0;
}

// What has happened to the camera itself, from the events of its descriptor.
struct Happened {
  bool broken = false;  // an error state, or unplugged
  bool event = false;   // one of V4L2's
};

Happened happened_to(int poll, int camera) {
  std::array<epoll_event, 4> events{};
  const int count = ::epoll_wait(poll, events.data(), static_cast<int>(events.size()), 0);
  for (int i = 0; i < count; ++i) {
    const epoll_event& event = events[static_cast<std::size_t>(i)];
    if (event.data.fd != camera) continue;
    return {(event.events & (EPOLLERR | EPOLLHUP)) != 0, (event.events & EPOLLPRI) != 0};
  }
  return {};
}

}  // namespace

CameraSource::CameraSource(const CameraParameters& parameters, const CameraSystem& system)
    : parameters_(parameters),
      system_(system),
      controls_(std::make_shared<CameraControls>(system, parameters.controls)),
      poll_(::epoll_create1(EPOLL_CLOEXEC)) {
  if (!poll_ || !add_to_poll(poll_.get(), watch_.descriptor(), EPOLLIN) ||
      !add_to_poll(poll_.get(), timer_.descriptor(), EPOLLIN)) {
    throw std::system_error(errno, std::generic_category(), "epoll");
  }
  retry_at(monotonic_ns());
}

void CameraSource::follow(const FrameSource& before) {
  const auto* const other = dynamic_cast<const CameraSource*>(&before);
  if (other == nullptr) return;
  if (parameters_.choice == other->parameters_.choice) before_ = other->before_;
  if (parameters_.controls == other->parameters_.controls) {
    controls_->replace(other->controls_->wanted());
  }
}

std::optional<FrameLease> CameraSource::next() {
  if (watch_.take() && !camera_) {
    pause_ns_ = 0;
    retry_at(monotonic_ns());
  }
  if (!camera_) {
    if (timer_.take()) try_to_open();
    return std::nullopt;
  }
  try {
    const Happened happened = happened_to(poll_.get(), camera_->device->descriptor());
    if (happened.event && format_changed()) {
      lose("its picture format has changed");
      return std::nullopt;
    }
    std::optional<FrameLease> lease = take_newest(happened.broken);
    // A frame counts even if it comes late because we did.
    if (!lease) check_silence();
    return lease;
  } catch (const CameraError& error) {
    lose(error.what());
    return std::nullopt;
  }
}

void CameraSource::try_to_open() {
  try {
    const std::vector<CameraInformation> cameras = system_.cameras();
    camera_.emplace(open_camera(before_ ? find_again(cameras, *before_)
                                        : choose_camera(cameras, parameters_.choice)));
    watch_stream();
    controls_->attach(camera_->information.node);
  } catch (const CameraError& error) {
    camera_.reset();
    note_failure(error);
    schedule_retry();
  }
}

// All that is set for a camera is set anew here: it may have been unplugged, and so forgot.
CameraSource::OpenCamera CameraSource::open_camera(const CameraInformation& information) {
  const bool multiplanar = information.multiplanar;
  try {
    std::unique_ptr<VideoDevice> device = system_.open(information.node);
    // libv4l2 knows no formats with several planes.
    if (!multiplanar && !can_be_read(*device, multiplanar)) {
      device.reset();
      device = system_.open_converted(information.node);
    }
    CameraMode mode = set_mode(*device, multiplanar, parameters_.mode);
    LumaReader reader(mode.layout, mode.crop);
    for (std::string& remark : apply_controls(*device, controls_->wanted())) {
      mode.remarks.push_back("camera.controls: " + remark);
    }
    if (mode.remarks != told_remarks_) {
      for (const std::string& remark : mode.remarks) {
        log_warning("{}: {}", information.card, remark);
      }
      told_remarks_ = mode.remarks;
    }
    auto stream = std::make_unique<CaptureStream>(*device, multiplanar, parameters_.buffers);
    return {information,       std::move(device), std::move(mode), std::move(reader),
            std::move(stream), FrameClock(),      std::nullopt,    monotonic_ns()};
  } catch (const CameraError& error) {
    throw CameraError(fmt::format("{}: {}", describe(information), error.what()));
  }
}

bool CameraSource::can_be_read(VideoDevice& device, bool multiplanar) const {
  if (parameters_.mode.fourcc != 0) return true;  // nothing else will do
  const std::vector<OfferedFormat> offered = offered_formats(device, multiplanar);
  return std::any_of(offered.begin(), offered.end(), [](const OfferedFormat& format) {
    return find_pixel_format(format.fourcc) != nullptr;
  });
}

void CameraSource::watch_stream() {
  v4l2_event_subscription subscription{};
  subscription.type = V4L2_EVENT_SOURCE_CHANGE;
  camera_->device->control(VIDIOC_SUBSCRIBE_EVENT, &subscription);  // few drivers know it
  if (!add_to_poll(poll_.get(), camera_->device->descriptor(), EPOLLIN | EPOLLPRI)) {
    throw CameraError(fmt::format("{}: its driver has no way to wait for frames",
                                  describe(camera_->information)));
  }
  timer_.arm(camera_->last_frame_ns + patience_ns());
}

bool CameraSource::format_changed() {
  v4l2_event event{};
  for (int i = 0; i < kMostEvents && camera_->device->control(VIDIOC_DQEVENT, &event) == 0; ++i) {
    if (event.type == V4L2_EVENT_SOURCE_CHANGE &&
        (event.u.src_change.changes & V4L2_EVENT_SRC_CH_RESOLUTION) != 0) {
      return true;
    }
  }
  return false;
}

// While a camera is lost the log hears no more, but for one that is there and can't be used.
void CameraSource::note_failure(const CameraError& error) {
  reason_ = error.what();
  const bool absent = dynamic_cast<const CameraAbsent*>(&error) != nullptr;
  if (state_ == CameraState::kStarting) {
    if (error.what() != told_ && (told_.empty() || !absent)) {
      log_warning("no frames yet: {}; waits for the camera", error.what());
      told_ = error.what();
    }
  } else if (!absent && !told_in_vain_ && pause_ns_ >= kLongestPauseNs) {
    log_warning("the camera is still lost: {}", error.what());
    told_in_vain_ = true;
  }
}

void CameraSource::lose(const std::string& reason) {
  controls_->attach({});
  if (state_ == CameraState::kStreaming) {
    reason_ = fmt::format("{}: {}", describe(camera_->information), reason);
    log_warning("camera lost: {}; waits for it", reason_);
    state_ = CameraState::kLost;
  } else {
    note_failure(CameraError(fmt::format("{}: {}", describe(camera_->information), reason)));
  }
  // Closed now: otherwise it would come back under another number.
  ::epoll_ctl(poll_.get(), EPOLL_CTL_DEL, camera_->device->descriptor(), nullptr);
  camera_.reset();
  counts_ += std::exchange(later_, {});
  schedule_retry();
}

void CameraSource::retry_at(std::int64_t instant_ns) {
  retry_ns_ = instant_ns;
  timer_.arm(instant_ns);
}

void CameraSource::schedule_retry() {
  retry_at(monotonic_ns() + pause_ns_);
  pause_ns_ = std::clamp(2 * pause_ns_, kFirstPauseNs, kLongestPauseNs);
}

std::int64_t CameraSource::patience_ns() const {
  if (!camera_->any_frame) return kStartPatienceNs;
  const double rate = camera_->mode.frame_rate;
  const double frames_s = rate > 0 ? std::min(kLongestPatienceS, kPatienceFrames / rate) : 0;
  return static_cast<std::int64_t>(1e9 * std::max(parameters_.timeout_s, frames_s));
}

// The timer is not set for every frame, only when it strikes.
void CameraSource::check_silence() {
  if (!timer_.take()) return;
  const std::int64_t due_ns = camera_->last_frame_ns + patience_ns();
  if (monotonic_ns() < due_ns) {
    timer_.arm(due_ns);
    return;
  }
  const std::string damaged =
      camera_->damaged > 0 ? fmt::format(", but {} damaged ones", camera_->damaged) : "";
  throw CameraError(
      fmt::format("no frame for {:.1f} s{}", static_cast<double>(patience_ns()) / 1e9, damaged));
}

void CameraSource::note_frame() {
  camera_->last_frame_ns = monotonic_ns();
  camera_->damaged = 0;
  if (camera_->any_frame) return;
  camera_->any_frame = true;
  before_ = camera_->information;  // one that never gave a frame may be replaced by another
  timer_.arm(camera_->last_frame_ns + patience_ns());
  // The first time it is part of the summary.
  if (state_ == CameraState::kLost) log_info("the camera is back: {}", description());
  state_ = CameraState::kStreaming;
  pause_ns_ = 0;
  reason_.clear();
  told_.clear();
  told_in_vain_ = false;
}

std::string CameraSource::description() const {
  if (!camera_) {
    return before_ ? fmt::format("{}, not there", describe(*before_)) : "a camera, not there yet";
  }
  const PixelFormat& format = camera_->mode.layout.format;
  const std::string rate = camera_->mode.frame_rate > 0
                               ? fmt::format(" at {:.4g} frames/s", camera_->mode.frame_rate)
                               : std::string();
  return fmt::format("{}: {} {}x{}{}, {}{}{}", describe(camera_->information),
                     fourcc_name(format.fourcc), camera_->mode.layout.width,
                     camera_->mode.layout.height, rate, how_it_is_read(format),
                     camera_->mode.emulated ? " after libv4l2's conversion" : "",
                     camera_->stream->cached() ? ", cached buffers" : "");
}

// As find_again() knows it. Nothing before the first frame.
std::string CameraSource::identity() const {
  if (!before_) return {};
  return before_->serial.empty() ? fmt::format("{} at {}", before_->card, before_->bus)
                                 : fmt::format("{}, serial {}", before_->card, before_->serial);
}

std::string CameraSource::crop() const {
  const Crop& crop = parameters_.mode.crop;
  if (crop.empty()) return {};
  return fmt::format("{}x{} from ({}, {})", crop.width, crop.height, crop.left, crop.top);
}

}  // namespace roundel
