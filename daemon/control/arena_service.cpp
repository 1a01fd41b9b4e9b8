#include "daemon/control/arena_service.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>
#include <utility>

#include "calibration/arena_file.hpp"
#include "daemon/control/ask_loop.hpp"
#include "daemon/log.hpp"
#include "transport/clock.hpp"

namespace roundel {
namespace {

constexpr std::int64_t kJudgePeriodUs = 250'000;
constexpr std::int64_t kRetryUs = 60'000'000;
constexpr std::int64_t kApplyingUs = 3'000'000;  // without a frame
constexpr const char* kNoFrame = "no frame has come from the camera yet";
constexpr const char* kNoIntrinsics =
    "the camera is not calibrated: without its intrinsics (camera.calibration) there is no arena";

std::string utc_date() {
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
}

}  // namespace

// The one in use, whether there are frames or not.
ArenaStore ArenaService::store() {
  return ArenaStore(
      ask_loop(loop_, [](LoopControl& loop) { return loop.configuration().arena.file; }));
}

void ArenaService::start(const ArenaRequest& request) {
  check(request);
  const std::lock_guard lock(mutex_);
  if (waiting_ || calibrator_ || applying_) {
    throw std::runtime_error("a calibration is running already");
  }
  if (context_ && !context_->camera) throw std::runtime_error(kNoIntrinsics);
  if (context_) {
    begin(request, now().mono_us);
  } else {
    waiting_ = request;
    show_running("waiting for the first frame", now().mono_us);
  }
}

void ArenaService::show_running(const char* text, std::int64_t now_us) {
  started_us_ = judged_us_ = now_us;
  progress_ = {};
  progress_.state = CalibrationProgress::State::kRunning;
  progress_.text = text;
}

void ArenaService::begin(const ArenaRequest& request, std::int64_t now_us) {
  calibrator_.emplace(request, context_->arena_camera, context_->diameter_m);
  file_ = context_->arena_file;
  show_running("waiting for frames", now_us);
}

// The first frame has come.
void ArenaService::begin_waiting() {
  const ArenaRequest request = *std::exchange(waiting_, std::nullopt);
  if (context_->camera) {
    begin(request, now().mono_us);
  } else {
    end(CalibrationProgress::State::kFailed, kNoIntrinsics);
  }
}

void ArenaService::cancel() {
  const std::lock_guard lock(mutex_);
  if (waiting_ || calibrator_) end(CalibrationProgress::State::kFailed, "it was cancelled");
}

ArenaCalibration ArenaService::restore() {
  ArenaStore kept = store();
  const std::lock_guard lock(mutex_);
  ArenaCalibration calibration = kept.restore();
  log_info("arena: the calibration of {} is in use again", calibration.date);
  use(calibration);
  return calibration;
}

void ArenaService::forget() {
  ArenaStore kept = store();
  const std::lock_guard lock(mutex_);
  if (!kept.forget()) return;
  log_info("arena: the calibration has been put aside");
  loop_.post([](LoopControl& loop) { loop.set_arena(nullptr); });
}

CalibrationProgress ArenaService::progress() const {
  const std::lock_guard lock(mutex_);
  return progress_;
}

std::string ArenaService::watch_text() const {
  const std::lock_guard lock(mutex_);
  return watch_ ? watch_->text() : "";
}

void ArenaService::on_frame(const FrameSnapshot& frame) {
  const std::lock_guard lock(mutex_);
  // A calibration belongs to one camera: another one in its middle ends it.
  if (calibrator_ && context_ &&
      (!frame.context->camera ||
       !mismatch(context_->arena_camera, frame.context->arena_camera).empty())) {
    end(CalibrationProgress::State::kFailed, "the camera has changed meanwhile");
  }
  context_ = frame.context;
  if (waiting_) begin_waiting();
  if (applying_ && context_->calibration == applying_) {
    end(CalibrationProgress::State::kDone, "calibrated");
  }
  if (calibrator_) calibrator_->add(frame.markers);
  watch(frame);
}

void ArenaService::on_tick(std::int64_t now_us) {
  const std::lock_guard lock(mutex_);
  if (applying_ && now_us - applying_since_us_ > kApplyingUs) {
    end(CalibrationProgress::State::kDone, "calibrated");
  }
  advance(now_us);
}

void ArenaService::advance(std::int64_t now_us) {
  if ((!waiting_ && !calibrator_) || now_us - judged_us_ < kJudgePeriodUs) return;
  judged_us_ = now_us;
  progress_.elapsed_s = static_cast<double>(now_us - started_us_) / 1e6;
  if (waiting_) {
    if (progress_.elapsed_s >= waiting_->time_limit_s) {
      end(CalibrationProgress::State::kFailed, kNoFrame);
    }
    return;
  }
  const ArenaCalibrator::Progress reached = calibrator_->progress();
  progress_.frames = reached.frames;
  progress_.markers = reached.markers;
  progress_.certainty_m = reached.certainty_m;
  progress_.text = reached.text;
  if (reached.done || progress_.elapsed_s >= calibrator_->request().time_limit_s) finish();
}

void ArenaService::end(CalibrationProgress::State state, std::string text) {
  waiting_.reset();
  calibrator_.reset();
  applying_.reset();
  progress_.state = state;
  progress_.text = std::move(text);
}

void ArenaService::finish() {
  try {
    ArenaCalibration calibration = calibrator_->result();
    calibration.date = utc_date();
    calibration.version = ROUNDEL_VERSION;
    ArenaStore(file_).save(calibration);
    log_info("arena: calibrated from {} frames and {} markers, certain to {:.2f} mm; {}",
             calibration.frames, calibration.references.size(), 1000 * calibration.certainty_m,
             file_);
    applying_ = use(std::move(calibration));
    applying_since_us_ = now().mono_us;
    calibrator_.reset();
  } catch (const std::runtime_error& error) {
    log_warning("arena: not calibrated: {}", error.what());
    end(CalibrationProgress::State::kFailed, error.what());
  }
}

std::shared_ptr<const ArenaCalibration> ArenaService::use(ArenaCalibration calibration) {
  auto shared = std::make_shared<const ArenaCalibration>(std::move(calibration));
  loop_.post([shared](LoopControl& loop) { loop.set_arena(shared); });
  return shared;
}

void ArenaService::watch(const FrameSnapshot& frame) {
  const TrackingContext& context = *frame.context;
  const auto wanted = context.arena_in_use() ? context.calibration : nullptr;
  if (watched_ != wanted) {
    watched_ = wanted;
    watch_state_ = ArenaWatch::State::kUnknown;
    watch_.reset();
    if (watched_) watch_.emplace(*watched_);
  }
  if (!watch_ || !watch_->add(frame.markers, frame.information.captured.mono_us)) return;
  const ArenaWatch::State state = watch_->state();
  if (state != watch_state_) {
    const bool moved = state == ArenaWatch::State::kCameraMoved;
    if (moved || state == ArenaWatch::State::kCornerMoved) {
      log_warning("arena: {}", watch_->text());
    } else if (state == ArenaWatch::State::kInPlace) {
      log_info("arena: {}", watch_->text());
    }
    watch_state_ = state;
    loop_.post([moved](LoopControl& loop) { loop.set_arena_moved(moved); });
  }
  const std::int64_t now_us = now().mono_us;
  if (state == ArenaWatch::State::kCameraMoved && context.recalibrate && !calibrator_ &&
      now_us >= retry_us_) {
    retry_us_ = now_us + kRetryUs;
    log_info("arena: calibrating again, as arena.recalibrate says");
    begin(watched_->request, now_us);
  }
}

}  // namespace roundel
