#include "core/line_kernels.hpp"

#include <algorithm>
#include <type_traits>
#include <utility>

#include "core/simd.hpp"

namespace roundel {

namespace {

// Means of two that round up: what vector units have an instruction for.
ROUNDEL_INLINE unsigned mean(unsigned a, unsigned b) {
  return (a + b + 1) >> 1;
}

// Averages of pixels and of those a stride further in the same rows.
template <typename Stride>
ROUNDEL_INLINE void average_some(const std::uint8_t* upper, const std::uint8_t* lower,
                                 Stride stride, int count, std::uint8_t* __restrict out) {
  for (int i = 0; i < count; ++i) {
    const unsigned here = mean(upper[i * stride], lower[i * stride]);
    const unsigned next = mean(upper[(i + 1) * stride], lower[(i + 1) * stride]);
    out[i] = static_cast<std::uint8_t>(mean(here, next));
  }
}

// Strides are the compiler's to know, where they are those of all usual formats.
constexpr std::integral_constant<int, 1> kSideBySide;
constexpr std::integral_constant<int, 2> kEverySecond;

constexpr int kAtOnce = 64;

ROUNDEL_INLINE void average_line(const std::uint8_t* upper, const std::uint8_t* lower, int count,
                                 std::uint8_t* out) {
  if (count < kAtOnce) return average_some(upper, lower, kSideBySide, count, out);
  for (int i = 0; i < count; i += kAtOnce) {
    i = std::min(i, count - kAtOnce);  // the last ones overlap with those before
    average_some(upper + i, lower + i, kSideBySide, kAtOnce, out + i);
  }
}

// Whatever lies between the pixels is averaged as well, but with the last of them, beyond which
// there may be nothing.
ROUNDEL_INLINE void average_every_second(const std::uint8_t* upper, const std::uint8_t* lower,
                                         int count, std::uint8_t* out) {
  int i = 0;
  for (; i + kAtOnce < count; i += kAtOnce) {
    std::uint8_t all[2 * kAtOnce];  // NOLINT(modernize-avoid-c-arrays): written in full below
    for (int k = 0; k < 2 * kAtOnce; ++k) {
      const unsigned here = mean(upper[2 * i + k], lower[2 * i + k]);
      const unsigned next = mean(upper[2 * i + k + 2], lower[2 * i + k + 2]);
      all[k] = static_cast<std::uint8_t>(mean(here, next));
    }
    for (int k = 0; k < kAtOnce; ++k) out[i + k] = all[2 * k];
  }
  average_some(upper + 2 * i, lower + 2 * i, kEverySecond, count - i, out + i);
}

ROUNDEL_INLINE void average_pixels(const std::uint8_t* upper, const std::uint8_t* lower,
                                   std::ptrdiff_t stride, int count, std::uint8_t* out) {
  if (stride == 1) return average_line(upper, lower, count, out);
  if (stride == 2) return average_every_second(upper, lower, count, out);
  average_some(upper, lower, stride, count, out);
}

// A register of kBytes; each lane of 16 bytes works on blocks of its own.
template <int kBytes>
struct Register {
  using Type __attribute__((vector_size(kBytes))) = std::uint8_t;
};
template <int kBytes>
using Bytes = typename Register<kBytes>::Type;

// Byte i of the lower (upper) half of every lane of two registers in turn.
constexpr int interleaved(int i, int bytes, bool upper_half) {
  const int lane = i / 16 * 16, within = i % 16;
  return lane + (upper_half ? 8 : 0) + within / 2 + (within % 2) * bytes;
}
template <int kBytes, bool kUpper, int... i>
ROUNDEL_INLINE Bytes<kBytes> interleave(const Bytes<kBytes>& a, const Bytes<kBytes>& b,
                                        std::integer_sequence<int, i...> /*bytes*/) {
  return __builtin_shufflevector(a, b, interleaved(i, kBytes, kUpper)...);
}

// One step of reducing many registers at once: what two registers have of their blocks is folded to
// half and put into one.
template <int kBytes, typename Fold>
ROUNDEL_INLINE Bytes<kBytes> merge(const Bytes<kBytes>& a, const Bytes<kBytes>& b,
                                   const Fold& fold) {
  constexpr std::make_integer_sequence<int, kBytes> kAll;
  return fold(interleave<kBytes, false>(a, b, kAll), interleave<kBytes, true>(a, b, kAll));
}

// From 16 registers, one for each block of a lane, to one, of a byte a block. The last step's
// neighbours end side by side, so that registers eight apart are merged first.
template <int kBytes, typename Fold>
ROUNDEL_INLINE Bytes<kBytes> reduce(Bytes<kBytes>* registers, int count, const Fold& fold) {
  for (; count > 1; count /= 2) {
    for (int k = 0; k < count / 2; ++k) {
      registers[k] = merge<kBytes>(registers[k], registers[k + count / 2], fold);
    }
  }
  return registers[0];
}

// Byte i of lane k is that of block i * lanes + k: brought into the order of blocks by interleaving
// what is half of all lanes apart.
template <int kBytes>
ROUNDEL_INLINE void in_order(const Bytes<kBytes>& reduced, std::uint8_t* out) {
  constexpr int kLanes = kBytes / 16;
  constexpr std::make_integer_sequence<int, 16> kAll;
  Bytes<16> lanes[kLanes], next[kLanes];  // NOLINT(modernize-avoid-c-arrays): of vector types
  __builtin_memcpy(lanes, &reduced, kBytes);
  for (int step = 1; step < kLanes; step *= 2) {
    for (int k = 0; k < kLanes / 2; ++k) {
      next[2 * k] = interleave<16, false>(lanes[k], lanes[k + kLanes / 2], kAll);
      next[2 * k + 1] = interleave<16, true>(lanes[k], lanes[k + kLanes / 2], kAll);
    }
    __builtin_memcpy(lanes, next, kBytes);
  }
  __builtin_memcpy(out, lanes, kBytes);
}

template <int kBytes>
ROUNDEL_INLINE void bound_line(const std::uint8_t* line, std::size_t blocks, std::uint8_t* low,
                               std::uint8_t* high) {
  using V = Bytes<kBytes>;
  constexpr int kBlock = LineKernels::kBlock, kLanes = kBytes / 16;
  const auto least = [](const V& a, const V& b) __attribute__((always_inline)) {
    return a < b ? a : b;
  };
  const auto greatest = [](const V& a, const V& b) __attribute__((always_inline)) {
    return a > b ? a : b;
  };
  constexpr std::make_integer_sequence<int, kBytes> kAll;
  for (std::size_t b = 0; b < blocks; b += 16 * kLanes) {
    // As they lie in memory: block i is in lane i % kLanes of register i / kLanes.
    V lows[8], highs[8];  // NOLINT(modernize-avoid-c-arrays): of vector types
    for (int k = 0; k < 8; ++k) {
      V first, second;
      __builtin_memcpy(&first, line + b * kBlock + k * kBytes, kBytes);
      __builtin_memcpy(&second, line + b * kBlock + (k + 8) * kBytes, kBytes);
      const V left = interleave<kBytes, false>(first, second, kAll);
      const V right = interleave<kBytes, true>(first, second, kAll);
      lows[k] = least(left, right);
      highs[k] = greatest(left, right);
    }
    in_order<kBytes>(reduce<kBytes>(lows, 8, least), low + b);
    in_order<kBytes>(reduce<kBytes>(highs, 8, greatest), high + b);
  }
}

template <int kBytes>
ROUNDEL_INLINE void judge_line(const std::uint8_t* low, const std::uint8_t* high,
                               std::size_t blocks, std::uint8_t contrast,
                               const LineKernels::BlockLooks& looks) {
  using V = Bytes<kBytes>;
  const auto load = [](const std::uint8_t* from) __attribute__((always_inline)) {
    V bytes;
    __builtin_memcpy(&bytes, from, kBytes);
    return bytes;
  };
  const auto store = [](const V& bytes, std::uint8_t* to) __attribute__((always_inline)) {
    __builtin_memcpy(to, &bytes, kBytes);
  };
  const auto least = [](const V& a, const V& b) __attribute__((always_inline)) {
    return a < b ? a : b;
  };
  const auto greatest = [](const V& a, const V& b) __attribute__((always_inline)) {
    return a > b ? a : b;
  };
  const V wanted = V{} + contrast;
  for (std::size_t i = 0; i < blocks; i += kBytes) {
    const V here_low = load(low + i + 1), here_high = load(high + i + 1);
    const V l = least(least(load(low + i), here_low), load(low + i + 2));
    const V h = greatest(greatest(load(high + i), here_high), load(high + i + 2));
    const V half = (l | h) - ((l ^ h) >> 1);  // rounded up
    const V contrasted = V(h - l >= wanted);
    store(half, looks.threshold + i);
    store((here_low & here_high) + ((here_low ^ here_high) >> 1), looks.middle + i);
    store(contrasted, looks.contrasted + i);
    store(contrasted & V(here_low < half) & V(here_high >= half), looks.crossing + i);
  }
}

// NOLINTBEGIN(bugprone-macro-parentheses): attributes and names take none.
#define ROUNDEL_LINE_KERNELS(suffix, attribute, bytes)                                           \
  attribute void average_##suffix(const std::uint8_t* upper, const std::uint8_t* lower,          \
                                  std::ptrdiff_t pixel_stride, int count, std::uint8_t* out) {   \
    average_pixels(upper, lower, pixel_stride, count, out);                                      \
  }                                                                                              \
  attribute void bound_##suffix(const std::uint8_t* line, std::size_t blocks, std::uint8_t* low, \
                                std::uint8_t* high) {                                            \
    bound_line<bytes>(line, blocks, low, high);                                                  \
  }                                                                                              \
  attribute void judge_##suffix(const std::uint8_t* low, const std::uint8_t* high,               \
                                std::size_t blocks, std::uint8_t contrast,                       \
                                const LineKernels::BlockLooks& looks) {                          \
    judge_line<bytes>(low, high, blocks, contrast, looks);                                       \
  }                                                                                              \
  constexpr LineKernels k_kernels_##suffix{average_##suffix, bound_##suffix, judge_##suffix};
// NOLINTEND(bugprone-macro-parentheses)

ROUNDEL_LINE_KERNELS(baseline, , 16)
#if defined(__x86_64__)
ROUNDEL_LINE_KERNELS(avx2, ROUNDEL_TARGET_AVX2, 32)
ROUNDEL_LINE_KERNELS(avx512, ROUNDEL_TARGET_AVX512, 64)
#endif

}  // namespace

const LineKernels& line_kernels([[maybe_unused]] VectorUnit unit) {
#if defined(__x86_64__)
  static const int width = widest_vectors();
  if (unit == VectorUnit::kBest && width >= 512) return k_kernels_avx512;
  if (unit != VectorUnit::kBaseline && width >= 256) return k_kernels_avx2;
#endif
  return k_kernels_baseline;
}

}  // namespace roundel
