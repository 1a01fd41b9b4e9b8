#include "core/lens_kernel.hpp"

#include "core/simd.hpp"

namespace roundel {

namespace {

using simd::Float8;

ROUNDEL_INLINE Float8 value_of(const Cubic& c, const Float8& u, const Float8& v) {
  return u * (c[0] + u * (c[2] + u * c[5]) + v * (c[3] + u * c[6] + v * c[7])) +
         v * (c[1] + v * (c[4] + v * c[8]));
}

ROUNDEL_INLINE void remove(const std::array<Cubic, 2>& lens, float* x, float* y, int count) {
  for (int i = 0; i < count; i += simd::kLanes) {
    Float8 u, v;
    __builtin_memcpy(&u, x + i, sizeof u);
    __builtin_memcpy(&v, y + i, sizeof v);
    const Float8 nx = value_of(lens[0], u, v), ny = value_of(lens[1], u, v);
    __builtin_memcpy(x + i, &nx, sizeof nx);
    __builtin_memcpy(y + i, &ny, sizeof ny);
  }
}

void remove_baseline(const std::array<Cubic, 2>& lens, float* x, float* y, int count) {
  remove(lens, x, y, count);
}
#if defined(__x86_64__)
__attribute__((target("avx2"))) void remove_avx2(const std::array<Cubic, 2>& lens, float* x,
                                                 float* y, int count) {
  remove(lens, x, y, count);
}
#endif

}  // namespace

void remove_lens(const std::array<Cubic, 2>& lens, float* x, float* y, int count,
                 [[maybe_unused]] VectorUnit unit) {
#if defined(__x86_64__)
  static const bool wide = widest_vectors() >= 256;
  if (unit != VectorUnit::kBaseline && wide) return remove_avx2(lens, x, y, count);
#endif
  remove_baseline(lens, x, y, count);
}

}  // namespace roundel
