#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "calibration/arena_calibration.hpp"
#include "config/configuration.hpp"
#include "daemon/control/wakeup.hpp"

namespace roundel {

class CameraControls;
class RecordingQueue;

// What other threads may ask of the thread that carries frames; called on that thread, between
// frames.
class LoopControl {
 public:
  virtual ~LoopControl() = default;
  // The configuration in use.
  virtual Configuration configuration() = 0;
  // Empty, or why the configuration in use stays.
  virtual std::string reload() = 0;
  // Of the camera in use, for any thread; nullptr: the source has none.
  virtual std::shared_ptr<CameraControls> camera_controls() = 0;
  // nullptr: none any more.
  virtual void set_arena(std::shared_ptr<const ArenaCalibration> calibration) = 0;
  virtual void set_arena_moved(bool moved) = 0;
  // Frames go into the queue from the next one on, until it is closed; with `restart`, as a session
  // of their own, tracked as if there had been none before.
  virtual void start_recording(std::shared_ptr<RecordingQueue> queue, bool restart) = 0;
};

using LoopCommand = std::function<void(LoopControl&)>;

// Commands on their way to the frame loop. The loop polls the descriptor, so that it looks here
// only when there is something, and does not wait for the lock: if it is held, it comes back.
class LoopCommands {
 public:
  int descriptor() const { return wakeup_.descriptor(); }

  // Any thread.
  void post(LoopCommand command);

  // The loop's thread, when the descriptor is readable.
  void run(LoopControl& loop);

  // Whoever waits for a command to be run is told that it will not be.
  void drop_all();

 private:
  Wakeup wakeup_;
  std::mutex mutex_;
  std::vector<LoopCommand> waiting_;
  bool dropping_ = false;
};

}  // namespace roundel
