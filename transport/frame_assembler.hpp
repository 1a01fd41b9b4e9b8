#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "transport/safe_decode.hpp"

namespace roundel {

// A frame as it was received, all parts together.
struct ReceivedFrame {
  header_t header{};
  std::string camera;
  std::vector<marker_t> markers;
};

struct ReceptionCounts {
  std::int64_t frames = 0;   // complete frames
  std::int64_t lost = 0;     // frames that were sent but did not arrive whole, or too late
  std::int64_t garbage = 0;  // messages that are no frame, or contradict their frame's other parts
};

// Puts the parts of frames together, in whatever order they come, and counts what is missing.
// Frames leave in rising order: one that completes after a newer one is lost. Several senders on
// one channel are kept apart by their sessions. Memory is bounded whatever comes.
class FrameAssembler {
 public:
  // Takes one message; returns the frame that it completes, or nullptr. It holds until the next
  // call.
  const ReceivedFrame* take(Bytes message);

  const ReceptionCounts& counts() const { return counts_; }

 private:
  static constexpr std::size_t kPending = 8;  // frames that wait for parts
  static constexpr std::size_t kSenders = 8;

  // Not in use: parts_left == 0.
  struct Pending {
    ReceivedFrame frame;
    std::vector<bool> part_seen;
    std::size_t parts_left = 0;
    std::size_t markers_left = 0;
    std::uint64_t started = 0;
  };
  // Not in use: last_use == 0.
  struct Sender {
    std::int64_t session = 0, frame = 0, dropped = 0;  // of the last complete frame
    std::uint64_t last_use = 0;
  };

  Pending& pending_for(const frame_t& part);
  Sender* find_sender(std::int64_t session);
  bool add_part(Pending& pending, const frame_t& part);
  const ReceivedFrame* complete(Pending& pending);

  frame_t part_;
  std::array<Pending, kPending> pending_;
  std::array<Sender, kSenders> senders_;
  std::uint64_t clock_ = 0;  // counts messages
  ReceptionCounts counts_;
};

}  // namespace roundel
