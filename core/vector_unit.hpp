#pragma once

namespace roundel {

// Which vector instructions are used; the results are the same to the bit.
enum class VectorUnit {
  kBest,      // the widest that the processor has
  kNextBest,  // the one before it, if it has several
  kBaseline   // what every processor of the platform has
};

#if defined(__x86_64__)
// What functions are compiled for that run where widest_vectors() is 256 and 512. Without fused
// multiply-add, which would round otherwise than the baseline.
#define ROUNDEL_TARGET_AVX2 __attribute__((target("avx2")))
#define ROUNDEL_TARGET_AVX512 \
  __attribute__((target("avx2,avx512f,avx512vl,avx512bw,avx512dq,prefer-vector-width=512")))
#endif

// Bits of the widest vector instructions beyond the baseline that kernels are compiled for and this
// processor has; 0 without.
inline int widest_vectors() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
      __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq")) {
    return 512;
  }
  if (__builtin_cpu_supports("avx2")) return 256;
#endif
  return 0;
}

}  // namespace roundel
