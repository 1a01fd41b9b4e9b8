#include "core/photometric_kernel.hpp"

#include <algorithm>

#include "core/photometric_edges.hpp"
#include "core/simd.hpp"
#include "core/vector_unit.hpp"

namespace roundel {

namespace {

using photometric::Expected;
using photometric::PlanePoint;
using simd::splat;

// Rows of the linearised equations of some pixels, weighted; the residuals are the last column. So
// many groups of pixels at once that a sum is taken to memory once for all of them.
template <typename V>
constexpr std::size_t kGroups = kPixelBlock / simd::kLanesOf<V>;
constexpr std::size_t kBlocksAtOnce = 4;
template <int kUnknowns, typename V>
using Rows = std::array<std::array<V, kBlocksAtOnce * kGroups<V>>, kUnknowns + 1>;

template <typename V>
ROUNDEL_INLINE V load(const float* from) {
  V v;
  __builtin_memcpy(&v, from, sizeof v);
  return v;
}

// One group's rows; returns the weights.
template <int kUnknowns, typename V>
ROUNDEL_INLINE V fill_rows(const PhotometricModel& m, const PlanePoint<V>& p, const Expected<V>& e,
                           const V& grey, const V& root_weight, std::size_t group,
                           Rows<kUnknowns, V>& rows) {
  const V light = 1 + m.slope_x * p.x + m.slope_y * p.y;
  const V print = m.dark + m.contrast * e.bright;
  const V residual = (grey - light * print) * root_weight;
  const V size = simd::abs<V>(residual);
  V kept = splat<V>(1), root_trust = kept;
  if (simd::any(size > m.robust_scale)) {
    const V trust =
        simd::select<V>(size > m.robust_scale, m.robust_scale / (size + 1e-9F), splat<V>(1));
    kept = simd::select<V>(size > m.outlier, splat<V>(0), trust);
    root_trust = simd::sqrt<V>(kept);
  }
  const V weight = root_weight * root_trust;

  const V gain = weight * light * m.contrast;
  const V by_x = gain * (e.by_radius * p.cosine - e.by_arc * p.sine);
  const V by_y = gain * (e.by_radius * p.sine + e.by_arc * p.cosine);
  // What a pixel sees when its point of the marker rises out of the plane: it moves toward the eye.
  const float per_height = 1 / m.eye[2];
  const V by_rise = (by_x * (m.eye[0] - p.x) + by_y * (m.eye[1] - p.y)) * per_height;
  const auto row = [&](int unknown) -> V& {
    return rows[static_cast<std::size_t>(unknown)][group];
  };
  row(kMoveX) = -by_x;
  row(kMoveY) = -by_y;
  row(kMoveZ) = by_rise;
  row(kTurnX) = p.y * by_rise;
  row(kTurnY) = -p.x * by_rise;
  row(kTurnZ) = p.y * by_x - p.x * by_y;
  const V lit = weight * light;
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
  return simd::select<V>(root_weight > 0, kept, splat<V>(0));
}

// Sixteen sums of every sixteenth pixel each, however many pixels are worked on at once: in one
// register, or in two.
template <typename V>
constexpr std::size_t kParts = 16 / simd::kLanesOf<V>;
template <typename V>
using Sums16 = std::array<V, kParts<V>>;

template <typename V>
ROUNDEL_INLINE float total(const Sums16<V>& sums) {
  if constexpr (kParts<V> == 1) {
    return simd::sum(simd::lower_half(sums[0]) + simd::upper_half(sums[0]));
  } else {
    return simd::sum(sums[0] + sums[1]);
  }
}

constexpr std::size_t entry(std::size_t row, std::size_t column) {
  return row * (row + 1) / 2 + column;
}

// Products of the rows' pairs: the lower triangle, row by row.
template <std::size_t kColumns, typename V>
using Products = std::array<Sums16<V>, kColumns*(kColumns + 1) / 2>;

// Adds the products of some neighbouring rows and columns: as many as have their sums in registers.
// What is round (kRound) looks the same after a turn about its normal, whose products are left out.
constexpr std::size_t kTileRows = 4, kTileColumns = 3;
template <std::size_t kFirstRow, std::size_t kFirstColumn, bool kRound, int kUnknowns, typename V>
ROUNDEL_INLINE void add_tile(const Rows<kUnknowns, V>& rows, std::size_t groups,
                             Products<kUnknowns + 1, V>& products) {
  constexpr std::size_t kColumns = kUnknowns + 1;
  constexpr std::size_t kEndRow = std::min(kFirstRow + kTileRows, kColumns);
  const auto each = [](auto&& work) __attribute__((always_inline)) {
#pragma GCC unroll 4
    for (std::size_t r = kFirstRow; r < kEndRow; ++r) {
#pragma GCC unroll 3
      for (std::size_t c = kFirstColumn; c < kFirstColumn + kTileColumns; ++c) {
        if (c > r || (kRound && (r == kTurnZ || c == kTurnZ))) continue;
        work(r, c, (r - kFirstRow) * kTileColumns + c - kFirstColumn);
      }
    }
  };
  for (std::size_t part = 0; part < kParts<V>; ++part) {
    std::array<V, kTileRows * kTileColumns> sums{};
    each([&](std::size_t r, std::size_t c, std::size_t k)
             __attribute__((always_inline)) { sums[k] = products[entry(r, c)][part]; });
#pragma GCC unroll 1
    for (std::size_t group = part; group < groups; group += kParts<V>) {
      each([&](std::size_t r, std::size_t c, std::size_t k)
               __attribute__((always_inline)) { sums[k] += rows[r][group] * rows[c][group]; });
    }
    each([&](std::size_t r, std::size_t c, std::size_t k)
             __attribute__((always_inline)) { products[entry(r, c)][part] = sums[k]; });
  }
}

template <bool kRound, int kUnknowns, typename V, std::size_t kFirstRow = 0,
          std::size_t kFirstColumn = 0>
ROUNDEL_INLINE void add_products(const Rows<kUnknowns, V>& rows, std::size_t groups,
                                 Products<kUnknowns + 1, V>& products) {
  if constexpr (kFirstRow <= kUnknowns) {
    add_tile<kFirstRow, kFirstColumn, kRound, kUnknowns, V>(rows, groups, products);
    constexpr std::size_t kNextColumn = kFirstColumn + kTileColumns;
    if constexpr (kNextColumn < std::min<std::size_t>(kFirstRow + kTileRows, kUnknowns + 1)) {
      add_products<kRound, kUnknowns, V, kFirstRow, kNextColumn>(rows, groups, products);
    } else {
      add_products<kRound, kUnknowns, V, kFirstRow + kTileRows, 0>(rows, groups, products);
    }
  }
}

template <bool kRound, int kUnknowns, typename V, typename Model>
ROUNDEL_INLINE void add_pixels(const PhotometricModel& m, const PixelColumns& pixels,
                               PhotometricSums& sums, const Model& expect) {
  constexpr std::size_t kColumns = kUnknowns + 1;
  Products<kColumns, V> products{};
  Sums16<V> weights{};
  Rows<kUnknowns, V> rows;
  for (int i = 0; i < pixels.count;) {
    std::size_t groups = 0;
    for (; groups < kBlocksAtOnce * kGroups<V> && i < pixels.count;
         i += pixels.every * kPixelBlock) {
      for (int in_block = 0; in_block < kPixelBlock; in_block += simd::kLanesOf<V>, ++groups) {
        const int at = i + in_block;
        const auto p =
            photometric::plane_point<V>(m, load<V>(pixels.x + at), load<V>(pixels.y + at));
        weights[groups % kParts<V>] += fill_rows<kUnknowns, V>(
            m, p, expect(p), load<V>(pixels.grey + at), load<V>(pixels.weight + at), groups, rows);
      }
    }
    add_products<kRound, kUnknowns, V>(rows, groups, products);
  }
  constexpr std::size_t kEntries = entry(kUnknowns, 0);
  for (std::size_t k = 0; k < kEntries; ++k) sums.normal_matrix[k] += total<V>(products[k]);
  for (std::size_t k = 0; k < kUnknowns; ++k) {
    sums.right_side[k] += total<V>(products[kEntries + k]);
  }
  sums.squares += total<V>(products.back());
  sums.weights += total<V>(weights);
}

// The right side alone, and the sums of squares and weights: what parts of a marker pull at.
template <bool kRound, typename V, typename Model>
ROUNDEL_INLINE void add_pulls(const PhotometricModel& m, const PixelColumns& pixels,
                              PhotometricSums& sums, const Model& expect) {
  constexpr int kUnknowns = kPhotometricUnknowns;
  std::array<Sums16<V>, kUnknowns + 1> products{};
  Sums16<V> weights{};
  Rows<kUnknowns, V> rows;
  for (int i = 0; i < pixels.count; i += pixels.every * kPixelBlock) {
    for (int in_block = 0; in_block < kPixelBlock; in_block += simd::kLanesOf<V>) {
      const int at = i + in_block;
      const std::size_t part = static_cast<std::size_t>(in_block) / simd::kLanesOf<V> % kParts<V>;
      const auto p = photometric::plane_point<V>(m, load<V>(pixels.x + at), load<V>(pixels.y + at));
      weights[part] += fill_rows<kUnknowns, V>(m, p, expect(p), load<V>(pixels.grey + at),
                                               load<V>(pixels.weight + at), 0, rows);
#pragma GCC unroll 16
      for (std::size_t k = 0; k <= kUnknowns; ++k) {
        if (kRound && k == kTurnZ) continue;
        products[k][part] += rows[k][0] * rows[kUnknowns][0];
      }
    }
  }
  for (std::size_t k = 0; k < kUnknowns; ++k) sums.right_side[k] += total<V>(products[k]);
  sums.squares += total<V>(products.back());
  sums.weights += total<V>(weights);
}

// kUnknowns of 0: the pulls at all of them.
template <bool kRound, int kUnknowns, typename V, typename Model>
ROUNDEL_INLINE void add(const PhotometricModel& m, const PixelColumns& pixels,
                        PhotometricSums& sums, const Model& expect) {
  if constexpr (kUnknowns == 0) {
    add_pulls<kRound, V>(m, pixels, sums, expect);
  } else {
    add_pixels<kRound, kUnknowns, V>(m, pixels, sums, expect);
  }
}

template <int kUnknowns, bool kBoxed, typename V>
ROUNDEL_INLINE void add_outer(const PhotometricModel& m, const PixelColumns& pixels,
                              PhotometricSums& sums) {
  add<true, kUnknowns, V>(
      m, pixels, sums, [&](const PlanePoint<V>& p) __attribute__((always_inline)) {
        return photometric::outer_rim<kBoxed, V>(m, p);
      });
}

template <int kUnknowns, bool kBoxed, typename V>
ROUNDEL_INLINE void add_code(const PhotometricModel& m, const PixelColumns& pixels,
                             PhotometricSums& sums) {
  add<false, kUnknowns, V>(
      m, pixels, sums, [&](const PlanePoint<V>& p) __attribute__((always_inline)) {
        return photometric::code_ring<kBoxed, V>(m, p);
      });
}

template <int kUnknowns, bool kBoxed, typename V>
ROUNDEL_INLINE void add_plain(const PhotometricModel& m, const PixelColumns& pixels,
                              PhotometricSums& sums) {
  add<true, kUnknowns, V>(
      m, pixels, sums, [&](const PlanePoint<V>& p) __attribute__((always_inline)) {
        return photometric::plain_centre<kBoxed, V>(m, p);
      });
}

using Kernel = void (*)(const PhotometricModel&, const PixelColumns&, PhotometricSums&);
struct Kernels {
  struct Set {
    Kernel followed_outer, followed_code, code_outer, code_code, outer, plain;
    Kernel pulls_outer, pulls_code, pulls_plain;
  };
  Set gaussian, boxed;
};

// The attribute is the whole difference between the sets of kernels; the bodies are inlined.
// NOLINTBEGIN(bugprone-macro-parentheses): attributes and names take none.
#define ROUNDEL_KERNEL(name, attribute, part, unknowns, boxed, lanes)                         \
  attribute void name(const PhotometricModel& m, const PixelColumns& p, PhotometricSums& s) { \
    part<unknowns, boxed, lanes>(m, p, s);                                                    \
  }
#define ROUNDEL_KERNELS(set, attribute, boxed, lanes)                                         \
  ROUNDEL_KERNEL(set##_followed_outer, attribute, add_outer, kFollowedUnknowns, boxed, lanes) \
  ROUNDEL_KERNEL(set##_followed_code, attribute, add_code, kFollowedUnknowns, boxed, lanes)   \
  ROUNDEL_KERNEL(set##_code_outer, attribute, add_outer, kCodeUnknowns, boxed, lanes)         \
  ROUNDEL_KERNEL(set##_code_code, attribute, add_code, kCodeUnknowns, boxed, lanes)           \
  ROUNDEL_KERNEL(set##_outer, attribute, add_outer, kPhotometricUnknowns, boxed, lanes)       \
  ROUNDEL_KERNEL(set##_plain, attribute, add_plain, kPhotometricUnknowns, boxed, lanes)       \
  ROUNDEL_KERNEL(set##_pulls_outer, attribute, add_outer, 0, boxed, lanes)                    \
  ROUNDEL_KERNEL(set##_pulls_code, attribute, add_code, 0, boxed, lanes)                      \
  ROUNDEL_KERNEL(set##_pulls_plain, attribute, add_plain, 0, boxed, lanes)                    \
  constexpr Kernels::Set k_##set{set##_followed_outer, set##_followed_code, set##_code_outer, \
                                 set##_code_code,      set##_outer,         set##_plain,      \
                                 set##_pulls_outer,    set##_pulls_code,    set##_pulls_plain};

// NOLINTEND(bugprone-macro-parentheses)
ROUNDEL_KERNELS(baseline, , false, simd::Float8)
ROUNDEL_KERNELS(baseline_boxed, , true, simd::Float8)
constexpr Kernels kBaselineKernels{k_baseline, k_baseline_boxed};
#if defined(__x86_64__)
ROUNDEL_KERNELS(avx2, ROUNDEL_TARGET_AVX2, false, simd::Float8)
ROUNDEL_KERNELS(avx2_boxed, ROUNDEL_TARGET_AVX2, true, simd::Float8)
constexpr Kernels kAvx2Kernels{k_avx2, k_avx2_boxed};
// Twice as many registers, twice as wide.
ROUNDEL_KERNELS(avx512, ROUNDEL_TARGET_AVX512, false, simd::Float16)
ROUNDEL_KERNELS(avx512_boxed, ROUNDEL_TARGET_AVX512, true, simd::Float16)
constexpr Kernels kAvx512Kernels{k_avx512, k_avx512_boxed};
#endif

const Kernels& best_kernels([[maybe_unused]] VectorUnit unit) {
#if defined(__x86_64__)
  static const int width = widest_vectors();
  if (unit == VectorUnit::kBest && width >= 512) return kAvx512Kernels;
  if (unit != VectorUnit::kBaseline && width >= 256) return kAvx2Kernels;
#endif
  return kBaselineKernels;
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

void add_outer_pulls(const PhotometricModel& model, const PixelColumns& pixels,
                     PhotometricSums& sums, VectorUnit unit) {
  kernels(model, unit).pulls_outer(model, pixels, sums);
}

void add_inner_pulls(const PhotometricModel& model, const PixelColumns& pixels,
                     PhotometricSums& sums, VectorUnit unit) {
  const Kernels::Set& k = kernels(model, unit);
  (model.halves == 0 ? k.pulls_plain : k.pulls_code)(model, pixels, sums);
}

}  // namespace roundel
