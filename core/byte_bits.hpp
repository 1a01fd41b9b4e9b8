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

// Sixteen bytes from memory, and the same of every second one, which reads 32.
inline Byte16 load_16(const std::uint8_t* bytes) {
  Byte16 loaded;
  __builtin_memcpy(&loaded, bytes, sizeof loaded);
  return loaded;
}
inline Byte16 load_every_second(const std::uint8_t* bytes) {
  return __builtin_shufflevector(load_16(bytes), load_16(bytes + 16), 0, 2, 4, 6, 8, 10, 12, 14, 16,
                                 18, 20, 22, 24, 26, 28, 30);
}

// Bit i: byte i of 16 is below the threshold.
inline std::uint32_t bits_below(const std::uint8_t* bytes, std::uint8_t threshold) {
  return bits_of(load_16(bytes) < Byte16{} + threshold);
}

// The same of 64.
inline std::uint64_t bits_of_64_below(const std::uint8_t* bytes, std::uint8_t threshold) {
  std::uint64_t bits = 0;
  for (unsigned part = 0; part < 4; ++part) {
    bits |= std::uint64_t{bits_below(bytes + 16 * part, threshold)} << (16 * part);
  }
  return bits;
}

// Bit i: byte 2 i is below the threshold, of 64. Reads one byte more than the last of them.
inline std::uint64_t bits_of_64_below_every_second(const std::uint8_t* bytes,
                                                   std::uint8_t threshold) {
  std::uint64_t bits = 0;
  for (unsigned part = 0; part < 4; ++part) {
    const Byte16 dark = load_every_second(bytes + 32 * part) < Byte16{} + threshold;
    bits |= std::uint64_t{bits_of(dark)} << (16 * part);
  }
  return bits;
}

}  // namespace roundel
