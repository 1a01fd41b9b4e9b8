#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "calibration/arena_calibrator.hpp"
#include "calibration/arena_file.hpp"
#include "calibration/arena_watch.hpp"
#include "daemon/control/frame_snapshot.hpp"
#include "daemon/control/loop_commands.hpp"

namespace roundel {

// How the calibration that runs, or ran last, is getting on.
struct CalibrationProgress {
  enum class State { kIdle, kRunning, kDone, kFailed };
  State state = State::kIdle;
  int frames = 0;
  std::size_t markers = 0;
  std::optional<double> certainty_m;
  double elapsed_s = 0;
  std::string text;  // what is missing; why it failed
};

// Calibrates the arena on request, keeps the file, and watches the fixed markers. All of it happens
// outside of the frame loop, on what frames leave behind.
class ArenaService {
 public:
  explicit ArenaService(LoopCommands& loop) : loop_(loop) {}

  // From any thread. They throw std::runtime_error with a sentence for the user; start() throws
  // std::invalid_argument for a request that makes no sense. Started before the first frame, it
  // waits for that, for as long as the time limit says, and then has that long once more.
  void start(const ArenaRequest& request);
  void cancel();
  ArenaCalibration restore();
  void forget();

  CalibrationProgress progress() const;
  // What the watch has found; empty before it has.
  std::string watch_text() const;

  // From one thread: every frame, or the newest of them; and now and then, also without frames.
  void on_frame(const FrameSnapshot& frame);
  void on_tick(std::int64_t now_us);

 private:
  ArenaStore store();
  void show_running(const char* text, std::int64_t now_us);
  void begin(const ArenaRequest& request, std::int64_t now_us);
  void begin_waiting();
  void advance(std::int64_t now_us);
  void end(CalibrationProgress::State state, std::string text);
  void finish();
  std::shared_ptr<const ArenaCalibration> use(ArenaCalibration calibration);
  void watch(const FrameSnapshot& frame);

  LoopCommands& loop_;
  mutable std::mutex mutex_;
  std::shared_ptr<const TrackingContext> context_;  // of the last frame
  std::optional<ArenaRequest> waiting_;             // for the first frame
  std::optional<ArenaCalibrator> calibrator_;       // while one runs
  std::string file_;                                // that it will be written to
  std::int64_t started_us_ = 0, judged_us_ = 0;
  // Made and kept, and on its way to the frame loop: done when a frame comes that was located by
  // it.
  std::shared_ptr<const ArenaCalibration> applying_;
  std::int64_t applying_since_us_ = 0;
  CalibrationProgress progress_;

  std::shared_ptr<const ArenaCalibration> watched_;
  std::optional<ArenaWatch> watch_;
  ArenaWatch::State watch_state_ = ArenaWatch::State::kUnknown;
  std::int64_t retry_us_ = 0;  // not to calibrate again by itself before
};

}  // namespace roundel
