#include "transport/frame_encoder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace roundel {

std::size_t lcm_overhead(const std::string& channel) {
  constexpr std::size_t kHeader = 8;
  return kHeader + channel.size() + 1;
}

FrameEncoder::FrameEncoder(std::string channel, const std::string& camera, int max_datagram)
    : channel_(std::move(channel)) {
  message_.camera = camera;
  message_.num_markers = 0;
  const std::size_t empty =
      lcm_overhead(channel_) + static_cast<std::size_t>(message_.getEncodedSize());
  const auto marker = static_cast<std::size_t>(marker_t()._getEncodedSizeNoHash());
  const auto limit = static_cast<std::size_t>(std::max(0, max_datagram));
  if (limit < empty + marker) {
    throw std::invalid_argument(
        fmt::format("a datagram of {} bytes has no room for a marker; at least {} bytes are needed",
                    limit, empty + marker));
  }
  markers_per_part_ = (limit - empty) / marker;
}

std::span<const Bytes> FrameEncoder::encode(const FrameInformation& information,
                                            std::span<const Marker> markers,
                                            std::span<const ArenaPose> arena) {
  const std::size_t most_parts = std::numeric_limits<std::int16_t>::max();
  markers = markers.first(std::min(markers.size(), most_parts * markers_per_part_));
  const std::size_t parts =
      std::max<std::size_t>(1, (markers.size() + markers_per_part_ - 1) / markers_per_part_);

  message_.header = to_message(information);
  message_.parts = static_cast<std::int16_t>(parts);
  message_.frame_markers = static_cast<std::int32_t>(markers.size());
  message_.markers.resize(std::min(markers.size(), markers_per_part_));
  message_.num_markers = static_cast<std::int32_t>(message_.markers.size());
  const auto largest = static_cast<std::size_t>(message_.getEncodedSize());
  if (buffer_.size() < parts * largest) buffer_.resize(parts * largest);

  parts_.clear();
  for (std::size_t part = 0; part < parts; ++part) {
    const std::size_t first = part * markers_per_part_;
    const std::size_t count = std::min(markers.size() - first, markers_per_part_);
    message_.part = static_cast<std::int16_t>(part);
    message_.first_marker = static_cast<std::int32_t>(first);
    message_.num_markers = static_cast<std::int32_t>(count);
    for (std::size_t i = 0; i < count; ++i) {
      message_.markers[i] =
          to_message(markers[first + i], arena.empty() ? ArenaPose() : arena[first + i]);
    }
    std::uint8_t* const start = buffer_.data() + part * largest;
    const int size = message_.encode(start, 0, static_cast<int>(largest));
    parts_.emplace_back(start, static_cast<std::size_t>(size));
  }
  return parts_;
}

}  // namespace roundel
