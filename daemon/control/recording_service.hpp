#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "daemon/control/http_message.hpp"
#include "daemon/control/loop_commands.hpp"
#include "daemon/control/recording_queue.hpp"

namespace roundel {

// Hands the frames of a running roundeld to one client at a time, all of them if it is fast enough.
class RecordingService {
 public:
  explicit RecordingService(LoopCommands& loop) : loop_(loop) {}

  // Starts with the next frame; ends when the stream does. `newest` tells the size of frames.
  // With `restart`, tracking begins anew with the first frame, so that whoever tracks the recording
  // gets the same poses. Throws std::logic_error while somebody else records, std::runtime_error if
  // the frame loop does not answer.
  //
  // The stream: a line of JSON about the recording (recording_json.hpp), then for each frame a line
  // of JSON and, behind it, its width x height bytes of luma.
  std::unique_ptr<HttpStream> start(const FrameSnapshot& newest, double frame_rate, bool restart);

  // Now and then: returns the memory of recordings that have ended, which is not for the loop to
  // do.
  void on_tick();

 private:
  LoopCommands& loop_;
  std::mutex mutex_;
  std::vector<std::shared_ptr<RecordingQueue>> queues_;  // the last is in use unless it is closed
};

}  // namespace roundel
