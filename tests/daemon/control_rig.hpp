#pragma once

#include <poll.h>

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "daemon/control/control_center.hpp"
#include "tests/calibration/arena_scene.hpp"
#include "tests/daemon/unix_client.hpp"
#include "tests/temporary_directory.hpp"
#include "transport/clock.hpp"

namespace roundel::test {

// A control center with a frame loop that shows what a scene's camera sees, without pictures being
// tracked: 200 frames a second, on a thread of its own.
class ControlRig final : public LoopControl {
 public:
  // Without frames until show_frames(), if so wanted.
  explicit ControlRig(bool shows_frames = true)
      : context_(std::make_shared<TrackingContext>()), shows_frames_(shows_frames) {
    TrackingContext context;
    context.camera_name = "ceiling";
    context.camera = scene_.camera();
    context.diameter_m = kDiameter;
    context.arena_camera = scene_.arena_camera();
    context.arena_file = folder_.file("arena.yaml");
    context_ = std::make_shared<const TrackingContext>(context);
    center_.serve({socket(), "", "", ""});
    loop_ = std::thread([this] { run(); });
  }
  ~ControlRig() override {
    ending_ = true;
    loop_.join();
  }
  ControlRig(const ControlRig&) = delete;
  ControlRig& operator=(const ControlRig&) = delete;

  std::string socket() const { return folder_.file("control.sock"); }
  std::string file() const { return folder_.file("arena.yaml"); }
  // Longest that the loop needed for leaving its frame, microseconds, for each frame.
  std::vector<double> hand_over_us() {
    ending_ = true;
    loop_.join();
    loop_ = std::thread([] {});
    return hand_over_us_;
  }
  std::int64_t frames() const { return frames_; }

  void show_frames() { shows_frames_ = true; }
  // Somebody knocks against the camera.
  void bump() { bumped_ = true; }

  std::atomic<int> arenas_set{0};
  std::atomic<bool> moved{false};
  std::string reload_error;
  std::string moved_socket;  // by a reload

 private:
  std::string reload() override {
    if (!moved_socket.empty()) center_.serve({moved_socket, "", "", ""});
    return reload_error;
  }
  std::shared_ptr<CameraControls> camera_controls() override { return nullptr; }
  void set_arena(std::shared_ptr<const ArenaCalibration> calibration) override {
    TrackingContext context = *context_;
    context.calibration = std::move(calibration);
    context.recalibrate = true;
    if (context.calibration) ++arenas_set;
    context_ = std::make_shared<const TrackingContext>(context);
  }
  void set_arena_moved(bool is) override { moved = is; }
  Configuration configuration() override {
    Configuration values;
    values.arena.file = file();
    return values;
  }
  void start_recording(std::shared_ptr<RecordingQueue>, bool) override {}

  void run() {
    std::int64_t due_ns = monotonic_ns();
    while (!ending_) {
      due_ns += 5'000'000;
      const auto wait_ms = std::max<std::int64_t>(0, (due_ns - monotonic_ns()) / 1'000'000);
      pollfd descriptor = {center_.commands().descriptor(), POLLIN, 0};
      ::poll(&descriptor, 1, static_cast<int>(wait_ms));
      if (bumped_.exchange(false)) scene_.look(0.02, 0.11);
      const std::vector<Marker> markers = plain_corners(scene_);
      const std::int64_t start_ns = monotonic_ns();
      if (descriptor.revents != 0) center_.commands().run(*this);
      if (!shows_frames_) continue;
      FrameSnapshot& snapshot = center_.next_snapshot();
      snapshot.has_picture = center_.wants_picture();
      if (snapshot.has_picture) snapshot.picture.resize(1920, 1080);
      snapshot.information.frame = ++frames_;
      // What takes seconds of watching shall not take them here.
      snapshot.information.captured = {0, frames_ * 50'000};
      snapshot.markers.assign(markers.begin(), markers.end());
      snapshot.context = context_;
      center_.offer_snapshot();
      hand_over_us_.push_back(static_cast<double>(monotonic_ns() - start_ns) / 1000);
    }
  }

  TemporaryDirectory folder_;
  ArenaScene scene_;
  std::shared_ptr<const TrackingContext> context_;
  std::atomic<bool> ending_{false}, bumped_{false}, shows_frames_;
  std::atomic<std::int64_t> frames_{0};
  std::vector<double> hand_over_us_;
  ControlCenter center_;
  std::thread loop_;
};

}  // namespace roundel::test
