#include "core/photometric_kernel.hpp"

#include <utility>

#include "core/photometric_edges.hpp"
#include "core/simd.hpp"
#include "core/vector_unit.hpp"

namespace roundel {

namespace {

using photometric::Expected;
using photometric::PlanePoint;
using simd::Float8;
using simd::splat;

// Rows of the linearised equations of some pixels, weighted; the residuals are the last column. One
// group of eight pixels after the other, so that a sum is taken to memory once for several groups.
constexpr int kGroups = kPixelBlock / simd::kLanes;
template <int kUnknowns>
using Rows = std::array<std::array<Float8, kGroups>, kUnknowns + 1>;

ROUNDEL_INLINE Float8 load(const float* from) {
  Float8 v;
  __builtin_memcpy(&v, from, sizeof v);
  return v;
}

// One group's rows; returns the weights.
template <int kUnknowns>
ROUNDEL_INLINE Float8 fill_rows(const PhotometricModel& m, const PlanePoint& p, const Expected& e,
                                const Float8& grey, const Float8& root_weight, std::size_t group,
                                Rows<kUnknowns>& rows) {
  const Float8 light = 1 + m.slope_x * p.x + m.slope_y * p.y;
  const Float8 print = m.dark + m.contrast * e.bright;
  const Float8 residual = (grey - light * print) * root_weight;
  const Float8 size = simd::abs(residual);
  const Float8 trust =
      simd::select(size > m.robust_scale, m.robust_scale / (size + 1e-9F), splat(1));
  const Float8 kept = simd::select(size > m.outlier, splat(0), trust);
  const Float8 root_trust = simd::sqrt(kept);
  const Float8 weight = root_weight * root_trust;

  const Float8 gain = weight * light * m.contrast;
  const Float8 by_x = gain * (e.by_radius * p.cosine - e.by_arc * p.sine);
  const Float8 by_y = gain * (e.by_radius * p.sine + e.by_arc * p.cosine);
  // What a pixel sees when its point of the marker rises out of the plane: it moves toward the eye.
  const float per_height = 1 / m.eye[2];
  const Float8 by_rise = (by_x * (m.eye[0] - p.x) + by_y * (m.eye[1] - p.y)) * per_height;
  const auto row = [&](int unknown) -> Float8& {
    return rows[static_cast<std::size_t>(unknown)][group];
  };
  row(kMoveX) = -by_x;
  row(kMoveY) = -by_y;
  row(kMoveZ) = by_rise;
  row(kTurnX) = p.y * by_rise;
  row(kTurnY) = -p.x * by_rise;
  row(kTurnZ) = p.y * by_x - p.x * by_y;
  const Float8 lit = weight * light;
  row(kDark) = lit;
  row(kContrast) = lit * e.bright;
  row(kBlur) = gain * e.by_blur;
  row(kShift) = gain * e.by_shift;
  if constexpr (kUnknowns > kFollowedUnknowns) {
    row(kSlopeX) = weight * p.x * print;
    row(kSlopeY) = weight * p.y * print;
    row(kStretchU) = gain * e.by_stretch_u;
    row(kStretchD) = gain * e.by_stretch_d;
  }
  if constexpr (kUnknowns > kCodeUnknowns) row(kInner) = gain * e.by_inner;
  row(kUnknowns) = residual * root_trust;
  // Filling has no weight; otherwise a pixel counts by how far it is believed.
  return simd::select(root_weight > 0, kept, splat(0));
}

template <int kUnknowns, typename Model>
ROUNDEL_INLINE void add_pixels(const PhotometricModel& m, const PixelColumns& pixels,
                               PhotometricSums& sums, const Model& expect) {
  constexpr std::size_t kColumns = kUnknowns + 1;
  std::array<Float8, kColumns*(kColumns + 1) / 2> products{};
  Float8 weights = splat(0);
  Rows<kUnknowns> rows;
  for (int i = 0; i < pixels.count; i += pixels.every * kPixelBlock) {
    for (int group = 0; group < kGroups; ++group) {
      const int at = i + group * simd::kLanes;
      const PlanePoint p = photometric::plane_point(m, load(pixels.x + at), load(pixels.y + at));
      weights +=
          fill_rows<kUnknowns>(m, p, expect(p), load(pixels.grey + at), load(pixels.weight + at),
                               static_cast<std::size_t>(group), rows);
    }
    std::size_t at = 0;
    for (std::size_t r = 0; r < kColumns; ++r) {
      const auto row = rows[r];
      for (std::size_t c = 0; c <= r; ++c, ++at) {
        const auto& column = rows[c];
        products[at] +=
            (row[0] * column[0] + row[1] * column[1]) + (row[2] * column[2] + row[3] * column[3]);
      }
    }
  }
  constexpr std::size_t kEntries = kUnknowns * (kUnknowns + 1) / 2;
  for (std::size_t k = 0; k < kEntries; ++k) sums.normal_matrix[k] += simd::sum(products[k]);
  for (std::size_t k = 0; k < kUnknowns; ++k) {
    sums.right_side[k] += simd::sum(products[kEntries + k]);
  }
  sums.squares += simd::sum(products.back());
  sums.weights += simd::sum(weights);
}

template <int kUnknowns, bool kBoxed>
ROUNDEL_INLINE void add_outer(const PhotometricModel& m, const PixelColumns& pixels,
                              PhotometricSums& sums) {
  add_pixels<kUnknowns>(
      m, pixels, sums, [&](const PlanePoint& p) __attribute__((always_inline)) {
        return photometric::outer_rim<kBoxed>(m, p);
      });
}

template <int kUnknowns, bool kBoxed>
ROUNDEL_INLINE void add_code(const PhotometricModel& m, const PixelColumns& pixels,
                             PhotometricSums& sums) {
  add_pixels<kUnknowns>(
      m, pixels, sums, [&](const PlanePoint& p) __attribute__((always_inline)) {
        return photometric::code_ring<kBoxed>(m, p);
      });
}

template <int kUnknowns, bool kBoxed>
ROUNDEL_INLINE void add_plain(const PhotometricModel& m, const PixelColumns& pixels,
                              PhotometricSums& sums) {
  add_pixels<kUnknowns>(
      m, pixels, sums, [&](const PlanePoint& p) __attribute__((always_inline)) {
        return photometric::plain_centre<kBoxed>(m, p);
      });
}

using Kernel = void (*)(const PhotometricModel&, const PixelColumns&, PhotometricSums&);
struct Kernels {
  struct Set {
    Kernel followed_outer, followed_code, code_outer, code_code, outer, plain;
  };
  Set gaussian, boxed;
};

// The attribute is the whole difference between the sets of kernels; the bodies are inlined.
// NOLINTBEGIN(bugprone-macro-parentheses): attributes and names take none.
#define ROUNDEL_KERNEL(name, attribute, part, unknowns, boxed)                                \
  attribute void name(const PhotometricModel& m, const PixelColumns& p, PhotometricSums& s) { \
    part<unknowns, boxed>(m, p, s);                                                           \
  }
#define ROUNDEL_KERNELS(set, attribute, boxed)                                                \
  ROUNDEL_KERNEL(set##_followed_outer, attribute, add_outer, kFollowedUnknowns, boxed)        \
  ROUNDEL_KERNEL(set##_followed_code, attribute, add_code, kFollowedUnknowns, boxed)          \
  ROUNDEL_KERNEL(set##_code_outer, attribute, add_outer, kCodeUnknowns, boxed)                \
  ROUNDEL_KERNEL(set##_code_code, attribute, add_code, kCodeUnknowns, boxed)                  \
  ROUNDEL_KERNEL(set##_outer, attribute, add_outer, kPhotometricUnknowns, boxed)              \
  ROUNDEL_KERNEL(set##_plain, attribute, add_plain, kPhotometricUnknowns, boxed)              \
  constexpr Kernels::Set k_##set{set##_followed_outer, set##_followed_code, set##_code_outer, \
                                 set##_code_code,      set##_outer,         set##_plain};

// NOLINTEND(bugprone-macro-parentheses)
ROUNDEL_KERNELS(baseline, , false)
ROUNDEL_KERNELS(baseline_boxed, , true)
constexpr Kernels k_baseline_kernels{k_baseline, k_baseline_boxed};
#if defined(__x86_64__)
// Without fused multiply-add, which would round otherwise than the baseline.
ROUNDEL_KERNELS(avx2, __attribute__((target("avx2"))), false)
ROUNDEL_KERNELS(avx2_boxed, __attribute__((target("avx2"))), true)
constexpr Kernels k_avx2_kernels{k_avx2, k_avx2_boxed};
// Twice as many registers of the same width.
#define ROUNDEL_AVX512 __attribute__((target("avx2,avx512f,avx512vl,avx512bw,avx512dq")))
ROUNDEL_KERNELS(avx512, ROUNDEL_AVX512, false)
ROUNDEL_KERNELS(avx512_boxed, ROUNDEL_AVX512, true)
constexpr Kernels k_avx512_kernels{k_avx512, k_avx512_boxed};
#endif

const Kernels& best_kernels(VectorUnit unit) {
#if defined(__x86_64__)
  static const int width = widest_vectors();
  if (unit == VectorUnit::kBest && width >= 512) return k_avx512_kernels;
  if (unit != VectorUnit::kBaseline && width >= 256) return k_avx2_kernels;
#endif
  return k_baseline_kernels;
}

const Kernels::Set& kernels(const PhotometricModel& model, VectorUnit unit) {
  const Kernels& k = best_kernels(unit);
  return model.boxed ? k.boxed : k.gaussian;
}

}  // namespace

void add_outer_pixels(const PhotometricModel& model, const PixelColumns& pixels, int unknowns,
                      PhotometricSums& sums, VectorUnit unit) {
  const Kernels::Set& k = kernels(model, unit);
  const Kernel add = unknowns == kFollowedUnknowns ? k.followed_outer
                     : unknowns == kCodeUnknowns   ? k.code_outer
                                                   : k.outer;
  add(model, pixels, sums);
}

void add_inner_pixels(const PhotometricModel& model, const PixelColumns& pixels, int unknowns,
                      PhotometricSums& sums, VectorUnit unit) {
  const Kernels::Set& k = kernels(model, unit);
  const Kernel add = model.halves == 0               ? k.plain
                     : unknowns == kFollowedUnknowns ? k.followed_code
                                                     : k.code_code;
  add(model, pixels, sums);
}

}  // namespace roundel
