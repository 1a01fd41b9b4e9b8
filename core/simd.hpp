#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace roundel::simd {

// Eight or sixteen floats (integers) worked on at once, by the compiler's vector types: some SSE or
// NEON registers, one or two of AVX2, one of AVX-512, with the same result to the bit for every
// float on all of them (no fused multiply-add).
template <int kLanes>
struct Lanes {
  using Float __attribute__((vector_size(4 * kLanes))) = float;
};
using Float8 = Lanes<8>::Float;
using Float16 = Lanes<16>::Float;

// Integers and masks that go with floats.
template <typename V>
using IntOf = decltype(V{} < V{});

template <typename V>
constexpr int kLanesOf = static_cast<int>(sizeof(V) / sizeof(float));

#define ROUNDEL_INLINE inline __attribute__((always_inline))

template <typename V>
ROUNDEL_INLINE V splat(float x) {
  return V{} + x;
}

template <typename V>
ROUNDEL_INLINE V select(const IntOf<V>& mask, const V& yes, const V& no) {
  return mask ? yes : no;
}

template <typename V>
ROUNDEL_INLINE V min(const V& a, const V& b) {
  return a < b ? a : b;
}
template <typename V>
ROUNDEL_INLINE V max(const V& a, const V& b) {
  return a > b ? a : b;
}
template <typename V>
ROUNDEL_INLINE V abs(const V& a) {
  return a < 0 ? -a : a;
}

template <typename V>
ROUNDEL_INLINE V sqrt(const V& a) {
  V root;
  for (int i = 0; i < kLanesOf<V>; ++i) root[i] = std::sqrt(a[i]);
  return root;
}

ROUNDEL_INLINE Float8 lower_half(const Float16& a) {
  return __builtin_shufflevector(a, a, 0, 1, 2, 3, 4, 5, 6, 7);
}
ROUNDEL_INLINE Float8 upper_half(const Float16& a) {
  return __builtin_shufflevector(a, a, 8, 9, 10, 11, 12, 13, 14, 15);
}

ROUNDEL_INLINE bool any(const IntOf<Float8>& mask) {
  const IntOf<Float8> half = mask | __builtin_shufflevector(mask, mask, 4, 5, 6, 7, 0, 1, 2, 3);
  return (half[0] | half[1] | half[2] | half[3]) != 0;
}
ROUNDEL_INLINE bool any(const IntOf<Float16>& mask) {
  return any(IntOf<Float8>(__builtin_shufflevector(mask, mask, 0, 1, 2, 3, 4, 5, 6, 7) |
                           __builtin_shufflevector(mask, mask, 8, 9, 10, 11, 12, 13, 14, 15)));
}

ROUNDEL_INLINE float sum(const Float8& a) {
  return ((a[0] + a[4]) + (a[1] + a[5])) + ((a[2] + a[6]) + (a[3] + a[7]));
}

// Polynomials are taken apart into short chains: a processor works on several at a time.

// e^-y for y in [0, 12], to 3e-7 of the value.
template <typename V>
ROUNDEL_INLINE V exp_minus(const V& y) {
  const V x = y * -0.0625F;  // 16 times smaller: [-0.75, 0]
  const V x2 = x * x;
  const V high = (1 / 24.0F + x * (1 / 120.0F)) + x2 * (1 / 720.0F);
  V e = (1 + x) + x2 * ((0.5F + x * (1 / 6.0F)) + x2 * high);
  e *= e;
  e *= e;
  e *= e;
  return e * e;
}

// Angle of (x, y) in turns, [0, 1), to 1e-7; (0, 0) gives some angle.
template <typename V>
ROUNDEL_INLINE V turn_of(const V& x, const V& y) {
  const V ax = abs(x), ay = abs(y);
  const IntOf<V> steep = ay > ax;
  const V t = select<V>(steep, ax, ay) / (select<V>(steep, ay, ax) + 1e-20F);
  const V s = t * t, s2 = s * s, s4 = s2 * s2;
  // atan(t) / 2 pi on [0, 1], odd polynomial.
  const V low = (0.159154923F - s * 0.053050360F) + s2 * (0.031806932F - s * 0.022528074F);
  const V high = (0.016675522F - s * 0.011450219F) + s2 * (0.006262017F - s * 0.002252416F);
  V a = t * ((low + s4 * high) + (s4 * s4) * 0.000381676F);
  a = select<V>(steep, 0.25F - a, a);
  a = select<V>(x < 0, 0.5F - a, a);
  return select<V>(y < 0, 1.0F - a, a);
}

}  // namespace roundel::simd
