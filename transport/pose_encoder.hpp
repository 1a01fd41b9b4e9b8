#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "transport/frame_encoder.hpp"

namespace roundel {

// Encodes single markers as pose_t messages, each for a channel of its own. No allocation once ids
// as high have been seen.
class PoseEncoder {
 public:
  explicit PoseEncoder(const std::string& channel_prefix);

  // The markers of a frame that get a message: those with an id, one for each id, the most probable
  // (then the one with the lower track number). Holds until the next call.
  std::span<const Marker* const> select(std::span<const Marker> markers);

  // "<prefix>_POSE_<id>" and the message. They hold until the next call.
  const char* channel(const Marker& marker);
  Bytes encode(const FrameInformation& information, const Marker& marker,
               const ArenaPose& arena = {});

 private:
  std::string prefix_;
  std::vector<char> channel_;
  std::vector<std::uint8_t> buffer_;
  std::vector<const Marker*> selected_;
  std::vector<const Marker*> best_by_id_;  // all null between calls
};

}  // namespace roundel
