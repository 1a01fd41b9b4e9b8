#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tests/child_process.hpp"
#include "tests/lab/film.hpp"
#include "tests/temporary_directory.hpp"
#include "transport/subscriber.hpp"

namespace roundel {

// roundeld on a camera, and all that it sends. Times are CLOCK_MONOTONIC, microseconds.
class DaemonUnderTest {
 public:
  // settings: "KEY=VALUE". It knows the film's lens.
  DaemonUnderTest(const Film& film, const std::vector<std::string>& settings);

  struct Frame {
    header_t header{};
    std::vector<Film::Seen> seen;  // markers with ids
  };

  // Receives for a time, or until what was received is as wanted; false if the time is over.
  bool receive(
      int timeout_ms, const std::function<bool()>& wanted = [] { return false; });
  void forget();  // what was received

  const std::vector<Frame>& frames() const { return frames_; }
  const std::vector<status_t>& statuses() const { return statuses_; }

  // When the state was first published after an instant.
  std::optional<std::int64_t> published_us(int camera_state, std::int64_t after_us) const;
  // When the first frame with all four robots taken after an instant was published.
  std::optional<std::int64_t> poses_us(std::int64_t after_us) const;
  bool poses_arrive(int timeout_ms);  // frames with all four robots, from now on

  ChildProcess& process() { return process_; }
  const std::string& log();  // so far
  // Within two seconds: some lines come after the frame that they are about.
  bool has_logged(const std::string& text);
  std::string socket() const { return folder_.file("control.sock"); }
  int descriptors() const;
  // Of its memory: all that is resident, or only what is its own, without files and shared memory.
  long resident_kb() const { return process_.memory_kb("VmRSS:"); }
  long anonymous_kb() const { return process_.memory_kb("RssAnon:"); }

 private:
  const Film& film_;
  TemporaryDirectory folder_;
  Subscriber subscriber_;
  ChildProcess process_;
  std::vector<Frame> frames_;
  std::vector<status_t> statuses_;
};

// What frames must always be: of rising numbers and capture times, in time, and never published
// while the camera was lost. The first fault in words; empty: none.
std::string fault_in(const std::vector<DaemonUnderTest::Frame>& frames);

}  // namespace roundel
