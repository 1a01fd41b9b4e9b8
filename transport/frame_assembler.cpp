#include "transport/frame_assembler.hpp"

#include <algorithm>

namespace roundel {
namespace {

constexpr std::int32_t kMostMarkers = 20000;  // in a frame; twice what the daemon can be set to

bool is_plausible(const frame_t& part) {
  return part.parts >= 1 && part.part >= 0 && part.part < part.parts && part.frame_markers >= 0 &&
         part.frame_markers <= kMostMarkers && part.first_marker >= 0 &&
         part.first_marker <= part.frame_markers - part.num_markers &&
         (part.parts == 1 || part.num_markers > 0);
}

}  // namespace

const ReceivedFrame* FrameAssembler::take(Bytes message) {
  ++clock_;
  if (!decode(message, part_) || !is_plausible(part_)) {
    ++counts_.garbage;
    return nullptr;
  }
  const Sender* sender = find_sender(part_.header.session);
  if (sender != nullptr && part_.header.frame <= sender->frame) return nullptr;  // late, or again
  Pending& pending = pending_for(part_);
  if (!add_part(pending, part_)) {
    ++counts_.garbage;
    return nullptr;
  }
  return pending.parts_left == 0 ? complete(pending) : nullptr;
}

FrameAssembler::Pending& FrameAssembler::pending_for(const frame_t& part) {
  Pending* oldest = pending_.data();
  for (Pending& pending : pending_) {
    if (pending.parts_left > 0 && pending.frame.header.session == part.header.session &&
        pending.frame.header.frame == part.header.frame) {
      return pending;
    }
    const bool idle = pending.parts_left == 0;
    if ((idle && oldest->parts_left > 0) ||
        (idle == (oldest->parts_left == 0) && pending.started < oldest->started)) {
      oldest = &pending;
    }
  }
  oldest->frame.header = part.header;
  oldest->frame.camera = part.camera;
  oldest->frame.markers.resize(static_cast<std::size_t>(part.frame_markers));
  oldest->part_seen.assign(static_cast<std::size_t>(part.parts), false);
  oldest->parts_left = oldest->part_seen.size();
  oldest->markers_left = oldest->frame.markers.size();
  oldest->started = clock_;
  return *oldest;
}

bool FrameAssembler::add_part(Pending& pending, const frame_t& part) {
  const auto index = static_cast<std::size_t>(part.part);
  const auto count = static_cast<std::size_t>(part.num_markers);
  if (pending.part_seen.size() != static_cast<std::size_t>(part.parts) ||
      pending.frame.markers.size() != static_cast<std::size_t>(part.frame_markers)) {
    return false;
  }
  if (pending.part_seen[index]) return true;  // a duplicate
  const bool last = pending.parts_left == 1;
  if (last ? count != pending.markers_left : count >= pending.markers_left) return false;
  std::copy(part.markers.begin(), part.markers.end(),
            pending.frame.markers.begin() + part.first_marker);
  pending.part_seen[index] = true;
  pending.markers_left -= count;
  --pending.parts_left;
  return true;
}

FrameAssembler::Sender* FrameAssembler::find_sender(std::int64_t session) {
  for (Sender& sender : senders_) {
    if (sender.last_use > 0 && sender.session == session) return &sender;
  }
  return nullptr;
}

const ReceivedFrame* FrameAssembler::complete(Pending& pending) {
  const header_t& header = pending.frame.header;
  Sender* sender = find_sender(header.session);
  if (sender != nullptr) {
    // Differences of values that anybody may have sent: unsigned, so that nothing overflows.
    const auto frames =
        static_cast<std::uint64_t>(header.frame) - static_cast<std::uint64_t>(sender->frame);
    const auto dropped =
        static_cast<std::uint64_t>(header.dropped) - static_cast<std::uint64_t>(sender->dropped);
    constexpr std::uint64_t kPlausible = 1'000'000'000;
    if (dropped < frames && frames - dropped < kPlausible) {
      counts_.lost += static_cast<std::int64_t>(frames - dropped - 1);
    }
  } else {
    sender = &*std::min_element(
        senders_.begin(), senders_.end(),
        [](const Sender& a, const Sender& b) { return a.last_use < b.last_use; });
  }
  *sender = {header.session, header.frame, header.dropped, clock_};
  ++counts_.frames;
  return &pending.frame;
}

}  // namespace roundel
