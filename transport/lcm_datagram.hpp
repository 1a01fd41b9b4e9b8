#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "transport/message_sender.hpp"

namespace roundel {

// A message of LCM in one datagram: "LC02", its number (both big-endian), the channel with a zero,
// the message itself. (Longer messages travel as "LC03" fragments, which Roundel never sends.)
inline constexpr std::uint32_t kLcmMagic = 0x4c433032;
inline constexpr std::size_t kLcmHeaderBytes = 8;
inline constexpr std::size_t kLcmMostBytes = 65499;  // of channel, zero and message
inline constexpr std::size_t kLcmMostChannel = 63;   // characters

struct LcmDatagram {
  std::string_view channel;
  Bytes message;
};

// Nothing if it is none. The parts lie in the datagram.
std::optional<LcmDatagram> parse_lcm_datagram(Bytes datagram);

}  // namespace roundel
