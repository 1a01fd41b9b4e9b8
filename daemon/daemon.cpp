#include "daemon/daemon.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <system_error>
#include <utility>

#include "daemon/capture/frame_clock.hpp"
#include "daemon/log.hpp"
#include "daemon/setup.hpp"
#include "daemon/start_up_summary.hpp"
#include "transport/lcm_url.hpp"
#include "transport/route.hpp"

namespace roundel {
namespace {

constexpr std::int64_t kStatusPeriodNs = 1'000'000'000;
// A source may be late by so much on a busy machine.
constexpr std::int64_t kGraceNs = 1'000'000'000;

void copy(const LumaView& from, GreyImage& to) {
  to.resize(from.width, from.height);
  for (int v = 0; v < from.height; ++v) {
    std::uint8_t* const row =
        to.pixels.data() + static_cast<std::size_t>(v) * static_cast<std::size_t>(from.width);
    if (from.pixel_stride == 1) {
      std::copy_n(from.row(v), from.width, row);
    } else {
      for (int u = 0; u < from.width; ++u) row[u] = from.at(u, v);
    }
  }
}

}  // namespace

Daemon::Daemon(Load load, SignalDescriptor& signals, std::unique_ptr<ServiceLink> service)
    : load_(std::move(load)), signals_(signals), statistics_(now()), service_(std::move(service)) {
  Parts parts;
  parts.configuration = load_();
  parts.broadcast.emplace(make_broadcast(parts.configuration));
  parts.source = make_source(parts.configuration);
  parts.camera = make_camera(parts.configuration, *parts.source);
  parts.tracker.emplace(make_tracker(parts.configuration, parts.camera));
  start(std::move(parts));
  log_info("version {}, configuration: {}", ROUNDEL_VERSION, parts_.configuration.name);
  status_due_ns_ = monotonic_ns() + kStatusPeriodNs;
  status_timer_.arm(status_due_ns_);
}

int Daemon::run() {
  for (;;) {
    const Wakeup wakeup = wait();
    if (wakeup.signal) {
      const SignalEvent event = signals_.take();
      if (event == SignalEvent::kStop) break;
      if (event == SignalEvent::kReload) reload();
    }
    if (wakeup.status && status_timer_.take()) publish_status();
    if (wakeup.command) control_.commands().run(*this);
    if (wakeup.frame && !carry_frame()) break;
    tell_service_manager();
  }
  service_.stopping();
  publish_status();
  const DropCounts drops = drops_of_session();
  log_info(
      "{} frames tracked; {} lost before they reached roundeld, {} left out for a newer one, {} "
      "damaged, {} too old",
      statistics_.frames(), drops.lost, drops.newer, drops.damaged, drops.stale);
  if (parts_.source->complete()) {
    log_info("ends");
    return 0;
  }
  log_error("{} frames of the recording could not be read", parts_.source->dropped());
  return 1;
}

Daemon::Wakeup Daemon::wait() {
  std::array<pollfd, 4> descriptors = {{{signals_.descriptor(), POLLIN, 0},
                                        {status_timer_.descriptor(), POLLIN, 0},
                                        {control_.commands().descriptor(), POLLIN, 0},
                                        {parts_.source->descriptor(), POLLIN, 0}}};
  const int sleep_ms = service_.sleep_ms(monotonic_ns());
  if (::poll(descriptors.data(), descriptors.size(), sleep_ms) < 0 && errno != EINTR) {
    throw std::system_error(errno, std::generic_category(), "poll");
  }
  return {descriptors[0].revents != 0, descriptors[1].revents != 0, descriptors[2].revents != 0,
          descriptors[3].revents != 0};
}

// The way of a frame: take the newest, track, give back, publish. A picture that somebody wants is
// copied after that, so that no pose waits for it.
bool Daemon::carry_frame() {
  std::optional<FrameLease> lease = parts_.source->next();
  if (parts_.source->state() != information_.camera) take_state();
  if (!lease) return information_.camera != CameraState::kEnded;
  const CapturedFrame frame = lease->frame();
  FrameTimes times;
  times.captured_us = frame.captured.mono_us;
  times.arrived_us = frame.arrived_us;
  times.readable_us = now().mono_us;

  if (frame.luma.width != information_.width || frame.luma.height != information_.height) {
    fit_tracker(frame.luma.width, frame.luma.height);
  }
  const std::span<const Marker> markers = parts_.tracker->track(frame.luma);
  // Somebody who looks or records waits for the copy; robots don't.
  const bool looked_at = control_.wants_picture();
  if (recording_ && recording_->closed()) recording_.reset();
  if (!looked_at && !recording_) lease->give_back();
  const std::span<const ArenaPose> arena = arena_.locate(markers);
  times.tracked_us = now().mono_us;
  times.stages = parts_.tracker->stage_times();
  frame_carried_ = true;
  // A machine that slept, or a process that was stopped, in the midst of it: robots would take it
  // for news.
  if (!information_.simulated && times.tracked_us - times.captured_us > FrameClock::kOldestUs) {
    ++withheld_.stale;
    return true;
  }

  information_.frame = frame.number;
  information_.dropped = drops_of_session().total();
  information_.captured = frame.captured;
  information_.stamp_source = frame.stamp_source;
  information_.tracking_us = static_cast<double>(times.tracked_us - times.readable_us);
  parts_.broadcast->publish(information_, markers, arena);
  times.published_us = now().mono_us;
  statistics_.add(times, markers.size());
  if (recording_) record(frame.luma, markers, arena);
  fill(control_.next_snapshot(), markers, arena, looked_at ? &frame.luma : nullptr);
  control_.offer_snapshot();
  return true;
}

// For everything that happens beside the frames. Copies into memory that is kept.
void Daemon::fill(FrameSnapshot& snapshot, std::span<const Marker> markers,
                  std::span<const ArenaPose> arena, const LumaView* picture) {
  snapshot.has_picture = picture != nullptr;
  if (snapshot.has_picture) copy(*picture, snapshot.picture);
  snapshot.information = information_;
  snapshot.markers.assign(markers.begin(), markers.end());
  snapshot.arena.assign(arena.begin(), arena.end());
  snapshot.context = arena_.context();
}

void Daemon::record(const LumaView& luma, std::span<const Marker> markers,
                    std::span<const ArenaPose> arena) {
  RecordingQueue::Entry* const entry = recording_->back();
  if (entry == nullptr) return;
  fill(entry->frame, markers, arena, &luma);
  recording_->push();
}

void Daemon::start_recording(std::shared_ptr<RecordingQueue> queue, bool restart) {
  recording_ = std::move(queue);
  if (!restart) return;
  // The calibration fits or not; only frames of another size change that.
  const bool fits = information_.calibration == CalibrationState::kValid;
  parts_.tracker.emplace(make_tracker(parts_.configuration, fits ? parts_.camera : std::nullopt));
  begin_session();
}

// Subscribers hear of a lost camera at once. What was tracked before it was lost is not expected
// where it was.
void Daemon::take_state() {
  const CameraState before = information_.camera;
  information_.camera = parts_.source->state();
  status_.source = parts_.source->description();
  if (before == CameraState::kLost) {
    parts_.tracker->reset();
    fit_arena();
  }
  if (information_.camera == CameraState::kLost || before == CameraState::kLost) publish_status();
  report_state();
}

// A calibration holds for one resolution: frames of another one get no poses.
void Daemon::fit_tracker(int width, int height) {
  information_.width = width;
  information_.height = height;
  const CalibrationState before = information_.calibration;
  const std::optional<CameraModel>& camera = parts_.camera;
  const bool fits = camera && camera->width == width && camera->height == height;
  information_.calibration = fits     ? CalibrationState::kValid
                             : camera ? CalibrationState::kOtherResolution
                                      : CalibrationState::kNone;
  fit_arena();
  if (information_.calibration == before) return;
  parts_.tracker.emplace(make_tracker(parts_.configuration, fits ? camera : std::nullopt));
  begin_session();
  if (!fits && !told_of_other_resolution_) {
    told_of_other_resolution_ = true;
    log_error("calibrated at {}x{}, but frames are {}x{} now: no poses for these", camera->width,
              camera->height, width, height);
  }
}

void Daemon::load_arena_file() {
  const std::string& path = parts_.configuration.values.arena.file;
  if (path == arena_file_) return;
  arena_file_ = path;
  arena_calibration_ = load_arena(path, arena_file_problem_);
}

// Which arena coordinates there can be, with this source, lens, resolution and calibration.
void Daemon::fit_arena() {
  const Configuration& values = parts_.configuration.values;
  auto context = std::make_shared<TrackingContext>();
  context->camera_name = values.camera.name;
  if (information_.calibration == CalibrationState::kValid) context->camera = parts_.camera;
  context->diameter_m = values.detector.diameter_m;
  context->mode = values.arena.mode == "3d" ? ArenaMode::k3D : ArenaMode::k2D;
  context->arena_file = values.arena.file;
  context->recalibrate = values.arena.recalibrate;
  context->arena_camera.identity = parts_.source->identity();
  context->arena_camera.crop = parts_.source->crop();
  if (context->camera) context->arena_camera.intrinsics = *context->camera;
  context->calibration = arena_calibration_;
  context->problem = arena_file_problem_;
  if (arena_calibration_) {
    context->problem = context->camera ? mismatch(arena_calibration_->camera, context->arena_camera)
                                       : "the camera's intrinsics are not known at this resolution";
  }
  if (!context->problem.empty() && context->problem != told_arena_problem_) {
    log_warning("arena: the calibration in {} is not used: {}", values.arena.file,
                context->problem);
  }
  told_arena_problem_ = context->problem;
  arena_.configure(std::move(context), values.mount);
  information_.arena = arena_.state();
  information_.arena_mode = arena_.mode();
}

void Daemon::set_arena(std::shared_ptr<const ArenaCalibration> calibration) {
  arena_calibration_ = std::move(calibration);
  arena_file_problem_.clear();
  fit_arena();
}

void Daemon::set_arena_moved(bool moved) {
  arena_.set_moved(moved);
  information_.arena = arena_.state();
}

std::shared_ptr<CameraControls> Daemon::camera_controls() {
  return parts_.source->controls();
}

void Daemon::publish_status() {
  const TimeStamp current = now();
  // Instants that were missed while the machine slept are left out.
  while (status_due_ns_ <= current.mono_us * 1000) status_due_ns_ += kStatusPeriodNs;
  status_timer_.arm(status_due_ns_);
  parts_.broadcast->retry(monotonic_ns());
  information_.clock = clock_state();
  information_.camera = parts_.source->state();

  statistics_.report(current, status_);
  const int most_markers = parts_.configuration.values.detector.max_markers;
  if (status_.markers >= most_markers && !std::exchange(told_of_most_markers_, true)) {
    log_warning("{} markers are in view: detector.max_markers lets no more be reported",
                status_.markers);
  }
  status_.session = information_.session;
  status_.utime = current.wall_us;
  status_.mono = current.mono_us;
  const DropCounts drops = drops_of_session();
  status_.dropped = drops.total();
  status_.dropped_lost = drops.lost;
  status_.dropped_newer = drops.newer;
  status_.dropped_damaged = drops.damaged;
  status_.dropped_stale = drops.stale;
  status_.unsent = parts_.broadcast->unsent_frames() - unsent_before_session_;
  const header_t header = to_message(information_);
  status_.width = header.width;
  status_.height = header.height;
  status_.stamp_source = header.stamp_source;
  status_.clock_state = header.clock_state;
  status_.camera_state = header.camera_state;
  status_.calibration_state = header.calibration_state;
  status_.arena_state = header.arena_state;
  status_.arena_mode = header.arena_mode;
  status_.simulated = header.simulated;
  parts_.broadcast->publish(status_);
  control_.offer(status_);
  report_state();
}

// Takes parts that are ready to work. Does not fail.
void Daemon::start(Parts parts) {
  parts_ = std::move(parts);
  information_.width = parts_.source->width();
  information_.height = parts_.source->height();
  information_.camera = parts_.source->state();
  information_.calibration = parts_.camera ? CalibrationState::kValid : CalibrationState::kNone;
  information_.clock = clock_state();
  information_.simulated = parts_.source->simulated();
  told_of_other_resolution_ = told_of_most_markers_ = false;
  status_.camera = parts_.configuration.values.camera.name;
  status_.source = parts_.source->description();
  status_.url = parts_.configuration.values.lcm.url;
  status_.version = ROUNDEL_VERSION;
  load_arena_file();
  fit_arena();
  begin_session();
  control_.serve(parts_.configuration.values.control);
  summary_due_ = true;
}

DropCounts Daemon::drops_of_session() const {
  DropCounts drops = parts_.source->drops();
  drops += withheld_;
  return drops - drops_before_session_;
}

void Daemon::begin_session() {
  information_.session = std::max(now().wall_us, information_.session + 1);
  withheld_ = {};
  drops_before_session_ = parts_.source->drops();
  unsent_before_session_ = parts_.broadcast->unsent_frames();
  statistics_.begin_session();
}

void Daemon::log_summary() const {
  const Configuration& values = parts_.configuration.values;
  const LcmUrl url = parse_lcm_url(values.lcm.url);
  StartUpFacts facts{values, information_, parts_.source->description()};
  facts.arena = arena_calibration_.get();
  if (url.provider == LcmUrl::Provider::kUdp) facts.route = find_route(url.address, url.port);
  struct stat lens {};
  if (::stat(values.camera.calibration.c_str(), &lens) == 0) {
    facts.lens_written_s = static_cast<double>(lens.st_mtim.tv_sec);
  }
  for (const std::string& line : start_up_summary(facts)) log_info("{}", line);
  if (url.is_multicast() && url.ttl == 0) {
    log_warning(
        "lcm.url has ttl=0: poses stay on this machine; ttl=1 lets them out to the local "
        "network");
  }
}

// Ready is who has published a frame, or knows what keeps it from doing so. A sign of life is a
// frame, or a source that is not overdue: a loop that turns without either would not be fed.
void Daemon::tell_service_manager() {
  const bool carried = std::exchange(frame_carried_, false);
  if (carried && std::exchange(summary_due_, false)) log_summary();
  if (!service_.is_ready() && (carried || !parts_.source->waits_because().empty())) {
    report_state();
    service_.ready();
  }
  const std::int64_t now_ns = monotonic_ns();
  if (carried || now_ns <= parts_.source->due_ns() + kGraceNs) service_.alive(now_ns);
}

void Daemon::report_state() {
  ServiceStatus status;
  status.camera = information_.camera;
  status.calibration = information_.calibration;
  status.arena = information_.arena;
  status.frame_rate = service_rate_.steady(status_.frame_rate);
  status.source = status_.source;
  status.waits_because = parts_.source->waits_because();
  status.network = parts_.broadcast->is_open();
  status.url = status_.url;
  status.reload_error = reload_error_;
  write_status(status, service_text_);
  service_.status({service_text_.data(), service_text_.size()});
}

}  // namespace roundel
