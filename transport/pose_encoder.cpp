#include "transport/pose_encoder.hpp"

#include <algorithm>
#include <charconv>
#include <limits>

namespace roundel {
namespace {

constexpr std::int32_t kHighestId = 65535;  // 16 bits have 4080; bounds the table whatever comes

bool is_better(const Marker& a, const Marker& b) {
  if (a.id_probability != b.id_probability) return a.id_probability > b.id_probability;
  return a.track < b.track;
}

}  // namespace

PoseEncoder::PoseEncoder(const std::string& channel_prefix)
    : prefix_(channel_prefix + "_POSE_"),
      channel_(prefix_.size() + std::numeric_limits<std::int32_t>::digits10 + 3),
      buffer_(static_cast<std::size_t>(pose_t().getEncodedSize())) {
  std::copy(prefix_.begin(), prefix_.end(), channel_.begin());
}

std::span<const Marker* const> PoseEncoder::select(std::span<const Marker> markers) {
  selected_.clear();
  for (const Marker& marker : markers) {
    if (marker.id < 0 || marker.id > kHighestId) continue;
    const auto id = static_cast<std::size_t>(marker.id);
    if (best_by_id_.size() <= id) best_by_id_.resize(id + 1, nullptr);
    const Marker*& best = best_by_id_[id];
    if (best == nullptr || is_better(marker, *best)) best = &marker;
  }
  for (const Marker& marker : markers) {
    if (marker.id < 0 || marker.id > kHighestId) continue;
    const Marker*& best = best_by_id_[static_cast<std::size_t>(marker.id)];
    if (best != &marker) continue;
    selected_.push_back(&marker);
  }
  for (const Marker* marker : selected_)
    best_by_id_[static_cast<std::size_t>(marker->id)] = nullptr;
  return selected_;
}

const char* PoseEncoder::channel(const Marker& marker) {
  char* const number = channel_.data() + prefix_.size();
  char* const end = channel_.data() + channel_.size() - 1;
  *std::to_chars(number, end, marker.id).ptr = '\0';
  return channel_.data();
}

Bytes PoseEncoder::encode(const FrameInformation& information, const Marker& marker,
                          const ArenaPose& arena) {
  pose_t message{};
  message.header = to_message(information);
  message.marker = to_message(marker, arena);
  const int size = message.encode(buffer_.data(), 0, static_cast<int>(buffer_.size()));
  return {buffer_.data(), static_cast<std::size_t>(size)};
}

}  // namespace roundel
