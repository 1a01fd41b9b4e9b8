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

// e^-y for y in [0, 80], to 2e-7 of the value.
template <typename V>
ROUNDEL_INLINE V exp_minus(const V& y) {
  const V halvings = y * 1.44269504F;
  const IntOf<V> whole = __builtin_convertvector(halvings, IntOf<V>);
  const V x = halvings - __builtin_convertvector(whole, V), x2 = x * x;
  const V low = (0.999999925F - x * 0.693142253F) + x2 * (0.24017219F - x * 0.0552797233F);
  const V e = low + (x2 * x2) * (0.00918861209F - x * 0.000938788358F);
  return reinterpret_cast<V>(reinterpret_cast<IntOf<V>>(e) - (whole << 23));
}

// Angle of a direction of length 1 in turns, [0, 1], to 1e-7.
template <typename V>
ROUNDEL_INLINE V turn_of(const V& cosine, const V& sine) {
  const V ax = abs(cosine), ay = abs(sine);
  const IntOf<V> steep = ay > ax;
  const V t = min(ax, ay);
  const V s = t * t, s2 = s * s;
  // asin(t) / 2 pi up to the half of a right angle, odd polynomial.
  const V low = (0.159154044F + s * 0.0265724588F) + s2 * (0.0112521992F + s * 0.0113111208F);
  V a = t * (low + (s2 * s2) * (s * 0.0176938578F - 0.00709634218F));
  a = select<V>(steep, 0.25F - a, a);
  a = select<V>(cosine < 0, 0.5F - a, a);
  return select<V>(sine < 0, 1.0F - a, a);
}

}  // namespace roundel::simd
