#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "transport/message_sender.hpp"
#include "transport/messages.hpp"

namespace roundel {

// What LCM puts in front of a message that fits one datagram: 8 bytes, the channel, a zero.
std::size_t lcm_overhead(const std::string& channel);

// Encodes frames as frame_t messages, in as many parts as it takes for each datagram (message with
// LCM's overhead) to stay within a size. Keeps its memory: no allocation once a frame with as many
// markers has been encoded.
class FrameEncoder {
 public:
  // Throws std::invalid_argument if not even one marker fits into `max_datagram` bytes.
  FrameEncoder(std::string channel, const std::string& camera, int max_datagram);

  const std::string& channel() const { return channel_; }
  int markers_per_part() const { return static_cast<int>(markers_per_part_); }

  // The frame's parts in order, at least one. They hold until the next call. `arena` has one entry
  // a marker, or none at all.
  std::span<const Bytes> encode(const FrameInformation& information,
                                std::span<const Marker> markers,
                                std::span<const ArenaPose> arena = {});

 private:
  std::string channel_;
  frame_t message_;
  std::size_t markers_per_part_ = 0;
  std::vector<std::uint8_t> buffer_;
  std::vector<Bytes> parts_;
};

}  // namespace roundel
