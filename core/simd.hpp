#pragma once

#include <cmath>
#include <cstdint>

namespace roundel::simd {

// Eight floats (integers) worked on at once, by the compiler's vector types: two SSE or NEON
// registers or one of AVX2, with the same result to the bit on all of them (no fused multiply-add).
constexpr int kLanes = 8;
using Float8 = float __attribute__((vector_size(32)));
using Int8 = std::int32_t __attribute__((vector_size(32)));

#define ROUNDEL_INLINE inline __attribute__((always_inline))

ROUNDEL_INLINE Float8 splat(float x) {
  return Float8{x, x, x, x, x, x, x, x};
}

ROUNDEL_INLINE Float8 select(const Int8& mask, const Float8& yes, const Float8& no) {
  return mask ? yes : no;
}

ROUNDEL_INLINE Float8 min(const Float8& a, const Float8& b) {
  return a < b ? a : b;
}
ROUNDEL_INLINE Float8 max(const Float8& a, const Float8& b) {
  return a > b ? a : b;
}
ROUNDEL_INLINE Float8 abs(const Float8& a) {
  return a < 0 ? -a : a;
}

ROUNDEL_INLINE Float8 sqrt(const Float8& a) {
  Float8 root;
  for (int i = 0; i < kLanes; ++i) root[i] = std::sqrt(a[i]);
  return root;
}

ROUNDEL_INLINE bool any(const Int8& mask) {
  const Int8 half = mask | __builtin_shufflevector(mask, mask, 4, 5, 6, 7, 0, 1, 2, 3);
  return (half[0] | half[1] | half[2] | half[3]) != 0;
}

ROUNDEL_INLINE float sum(const Float8& a) {
  return ((a[0] + a[4]) + (a[1] + a[5])) + ((a[2] + a[6]) + (a[3] + a[7]));
}

// e^-y for y in [0, 12], to 3e-7 of the value.
ROUNDEL_INLINE Float8 exp_minus(const Float8& y) {
  const Float8 x = y * -0.0625F;  // 16 times smaller: [-0.75, 0]
  Float8 e = 1 / 120.0F + x * (1 / 720.0F);
  e = 1 / 24.0F + x * e;
  e = 1 / 6.0F + x * e;
  e = 0.5F + x * e;
  e = 1 + x * e;
  e = 1 + x * e;
  e *= e;
  e *= e;
  e *= e;
  return e * e;
}

// Angle of (x, y) in turns, [0, 1), to 1e-7; (0, 0) gives some angle.
ROUNDEL_INLINE Float8 turn_of(const Float8& x, const Float8& y) {
  const Float8 ax = abs(x), ay = abs(y);
  const Int8 steep = ay > ax;
  const Float8 t = select(steep, ax, ay) / (select(steep, ay, ax) + 1e-20F);
  const Float8 s = t * t;
  // atan(t) / 2 pi on [0, 1], odd polynomial.
  Float8 a = -0.002252416F + s * 0.000381676F;
  a = 0.006262017F + s * a;
  a = -0.011450219F + s * a;
  a = 0.016675522F + s * a;
  a = -0.022528074F + s * a;
  a = 0.031806932F + s * a;
  a = -0.053050360F + s * a;
  a = t * (0.159154923F + s * a);
  a = select(steep, 0.25F - a, a);
  a = select(x < 0, 0.5F - a, a);
  return select(y < 0, 1.0F - a, a);
}

}  // namespace roundel::simd
