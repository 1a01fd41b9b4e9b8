#include "core/lens_kernel.hpp"

#include "core/simd.hpp"

namespace roundel {

namespace {

template <typename V>
ROUNDEL_INLINE V value_of(const Cubic& c, const V& u, const V& v) {
  return u * (c[0] + u * (c[2] + u * c[5]) + v * (c[3] + u * c[6] + v * c[7])) +
         v * (c[1] + v * (c[4] + v * c[8]));
}

template <typename V>
ROUNDEL_INLINE void remove(const std::array<Cubic, 2>& lens, float* x, float* y, int count) {
  for (int i = 0; i < count; i += simd::kLanesOf<V>) {
    V u, v;
    __builtin_memcpy(&u, x + i, sizeof u);
    __builtin_memcpy(&v, y + i, sizeof v);
    const V nx = value_of(lens[0], u, v), ny = value_of(lens[1], u, v);
    __builtin_memcpy(x + i, &nx, sizeof nx);
    __builtin_memcpy(y + i, &ny, sizeof ny);
  }
}

void remove_baseline(const std::array<Cubic, 2>& lens, float* x, float* y, int count) {
  remove<simd::Float8>(lens, x, y, count);
}
#if defined(__x86_64__)
ROUNDEL_TARGET_AVX2 void remove_avx2(const std::array<Cubic, 2>& lens, float* x, float* y,
                                     int count) {
  remove<simd::Float8>(lens, x, y, count);
}
ROUNDEL_TARGET_AVX512 void remove_avx512(const std::array<Cubic, 2>& lens, float* x, float* y,
                                         int count) {
  remove<simd::Float16>(lens, x, y, count);
}
#endif

}  // namespace

void remove_lens(const std::array<Cubic, 2>& lens, float* x, float* y, int count,
                 [[maybe_unused]] VectorUnit unit) {
#if defined(__x86_64__)
  static const int width = widest_vectors();
  if (unit == VectorUnit::kBest && width >= 512) return remove_avx512(lens, x, y, count);
  if (unit != VectorUnit::kBaseline && width >= 256) return remove_avx2(lens, x, y, count);
#endif
  remove_baseline(lens, x, y, count);
}

}  // namespace roundel
