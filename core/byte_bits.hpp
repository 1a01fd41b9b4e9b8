#pragma once

#include <cstdint>
#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace roundel {

// Sixteen bytes worked on at once, by the compiler's vector types.
using Byte16 = std::uint8_t __attribute__((vector_size(16)));

// Bit i: byte i of a mask, as comparisons make them.
inline std::uint32_t bits_of(const Byte16& mask) {
#if defined(__SSE2__)
  return static_cast<std::uint32_t>(_mm_movemask_epi8(reinterpret_cast<const __m128i&>(mask)));
#else
  std::uint64_t halves[2];  // NOLINT(modernize-avoid-c-arrays)
  const Byte16 ones = mask & 1;
  __builtin_memcpy(halves, &ones, sizeof ones);
  // Gathers the lowest bit of each byte in the uppermost byte.
  constexpr std::uint64_t kGather = 0x0102040810204080;
  return static_cast<std::uint32_t>((halves[0] * kGather) >> 56U) |
         static_cast<std::uint32_t>((halves[1] * kGather) >> 56U) << 8U;
#endif
}

// Bit i: byte i of 16 is below the threshold.
inline std::uint32_t bits_below(const std::uint8_t* bytes, std::uint8_t threshold) {
  Byte16 levels;
  __builtin_memcpy(&levels, bytes, sizeof levels);
  return bits_of(levels < Byte16{} + threshold);
}

// The same of 64.
inline std::uint64_t bits_of_64_below(const std::uint8_t* bytes, std::uint8_t threshold) {
  std::uint64_t bits = 0;
  for (unsigned part = 0; part < 4; ++part) {
    bits |= std::uint64_t{bits_below(bytes + 16 * part, threshold)} << (16 * part);
  }
  return bits;
}

}  // namespace roundel
