#include "transport/lcm_datagram.hpp"

#include <algorithm>

namespace roundel {

std::optional<LcmDatagram> parse_lcm_datagram(Bytes datagram) {
  if (datagram.size() <= kLcmHeaderBytes) return std::nullopt;
  std::uint32_t magic = 0;
  for (std::size_t i = 0; i < 4; ++i) magic = magic << 8 | datagram[i];
  if (magic != kLcmMagic) return std::nullopt;
  const Bytes rest = datagram.subspan(kLcmHeaderBytes);
  const auto zero = std::find(rest.begin(), rest.end(), std::uint8_t{0});
  const auto length = static_cast<std::size_t>(zero - rest.begin());
  if (zero == rest.end() || length == 0 || length > kLcmMostChannel) return std::nullopt;
  return LcmDatagram{{reinterpret_cast<const char*>(rest.data()), length},
                     rest.subspan(length + 1)};
}

}  // namespace roundel
