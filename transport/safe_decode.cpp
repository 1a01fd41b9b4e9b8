#include "transport/safe_decode.hpp"

#include <cstring>
#include <limits>

namespace roundel {
namespace {

constexpr std::size_t kLengthBytes = 4;
constexpr std::size_t kEmptyStringBytes = kLengthBytes + 1;  // length and the closing zero

// A big-endian int32, as LCM writes lengths. The caller has checked that it lies in the message.
std::int64_t length_at(Bytes message, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < kLengthBytes; ++i) value = value << 8 | message[at + i];
  return static_cast<std::int32_t>(value);
}

// The place behind `count` strings that start at `at`; 0 if they do not lie in the message or are
// not closed by a zero.
std::size_t skip_strings(Bytes message, std::size_t at, int count) {
  for (int i = 0; i < count; ++i) {
    if (message.size() < at + kLengthBytes) return 0;
    const std::int64_t length = length_at(message, at);
    at += kLengthBytes;
    if (length < 1 || static_cast<std::uint64_t>(length) > message.size() - at) return 0;
    at += static_cast<std::size_t>(length);
    if (message[at - 1] != 0) return 0;
  }
  return at;
}

// The encoded size of a message with empty strings and lists.
template <typename Message>
std::size_t empty_size() {
  static const std::size_t size = [] {
    Message empty{};
    return static_cast<std::size_t>(empty.getEncodedSize());
  }();
  return size;
}

template <typename Message>
bool decode_all(Bytes message, Message& out) {
  if (message.size() > static_cast<std::size_t>(std::numeric_limits<int>::max())) return false;
  const int size = static_cast<int>(message.size());
  return out.decode(message.data(), 0, size) == size;
}

}  // namespace

bool decode(Bytes message, frame_t& out) {
  // frame_t ends with: num_markers, camera, markers.
  if (message.size() < empty_size<frame_t>()) return false;
  const std::size_t camera = empty_size<frame_t>() - kEmptyStringBytes;
  const std::int64_t markers = length_at(message, camera - kLengthBytes);
  const std::size_t first = skip_strings(message, camera, 1);
  const auto marker_bytes = static_cast<std::int64_t>(marker_t()._getEncodedSizeNoHash());
  if (first == 0 || markers < 0 ||
      static_cast<std::int64_t>(message.size() - first) != markers * marker_bytes) {
    return false;
  }
  return decode_all(message, out);
}

bool decode(Bytes message, pose_t& out) {
  return decode_all(message, out);
}

bool decode(Bytes message, status_t& out) {
  // status_t ends with: camera, source, url, version.
  constexpr int kStrings = 4;
  if (message.size() < empty_size<status_t>()) return false;
  const std::size_t first = empty_size<status_t>() - kStrings * kEmptyStringBytes;
  return skip_strings(message, first, kStrings) == message.size() && decode_all(message, out);
}

}  // namespace roundel
