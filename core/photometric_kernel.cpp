#include "core/photometric_kernel.hpp"

#include <utility>

#include "core/simd.hpp"

namespace roundel {

namespace {

using simd::Float8;
using simd::Int8;
using simd::splat;

// Value and slope of the normal distribution function: how a straight edge looks after Gaussian
// blur.
struct Edge {
  Float8 value, slope;
};

// Abramowitz and Stegun 26.2.17, absolute error below 1e-7.
ROUNDEL_INLINE Edge edge_profile(const Float8& d) {
  const Float8 x = simd::min(simd::abs(d), splat(4.8F));
  const Float8 slope = 0.39894228F * simd::exp_minus(0.5F * x * x);
  const Float8 t = 1 / (1 + 0.2316419F * x);
  Float8 tail = -1.821255978F + t * 1.330274429F;
  tail = 1.781477937F + t * tail;
  tail = -0.356563782F + t * tail;
  tail = slope * t * (0.319381530F + t * tail);
  return {simd::select(d > 0, 1 - tail, tail), slope};
}

// A pixel in the marker's plane.
struct PlanePoint {
  Float8 x, y, radius, cosine, sine;
  Float8 grad_x0, grad_x1, grad_y0, grad_y1;  // of plane coordinates, per pixel along u and v
};

ROUNDEL_INLINE PlanePoint plane_point(const PhotometricModel& m, const Float8& nx,
                                      const Float8& ny) {
  PlanePoint p{};
  const Float8 depth = 1 / (m.at[2] + m.by_x[2] * nx + m.by_y[2] * ny);
  p.x = (m.at[0] + m.by_x[0] * nx + m.by_y[0] * ny) * depth;
  p.y = (m.at[1] + m.by_x[1] * nx + m.by_y[1] * ny) * depth;
  p.radius = simd::sqrt(p.x * p.x + p.y * p.y) + 1e-9F;
  const Float8 per_radius = 1 / p.radius;
  p.cosine = p.x * per_radius;
  p.sine = p.y * per_radius;
  const Float8 xx = (m.by_x[0] - p.x * m.by_x[2]) * depth,
               xy = (m.by_y[0] - p.x * m.by_y[2]) * depth;
  const Float8 yx = (m.by_x[1] - p.y * m.by_x[2]) * depth,
               yy = (m.by_y[1] - p.y * m.by_y[2]) * depth;
  const auto& s = m.pixel_slope;
  p.grad_x0 = xx * s[0] + xy * s[2];
  p.grad_x1 = xx * s[1] + xy * s[3];
  p.grad_y0 = yx * s[0] + yy * s[2];
  p.grad_y1 = yx * s[1] + yy * s[3];
  return p;
}

// Plane units a pixel across the rims (along the radius) and along the ring.
ROUNDEL_INLINE Float8 slope_along(const PlanePoint& p, const Float8& cosine, const Float8& sine) {
  const Float8 g0 = cosine * p.grad_x0 + sine * p.grad_y0,
               g1 = cosine * p.grad_x1 + sine * p.grad_y1;
  return simd::sqrt(g0 * g0 + g1 * g1);
}

// Product of the two gradients, of the radius and of the arc.
ROUNDEL_INLINE Float8 along_and_across(const PlanePoint& p) {
  const Float8 g0 = p.cosine * p.grad_x0 + p.sine * p.grad_y0,
               g1 = p.cosine * p.grad_x1 + p.sine * p.grad_y1;
  const Float8 h0 = p.cosine * p.grad_y0 - p.sine * p.grad_x0,
               h1 = p.cosine * p.grad_y1 - p.sine * p.grad_x1;
  return g0 * h0 + g1 * h1;
}

// What the model expects of a pixel, and its derivatives.
struct Expected {
  Float8 bright;             // share of the bright level
  Float8 by_radius, by_arc;  // by an outward, a counter-clockwise shift of the pixel, plane units
  Float8 by_shift, by_blur, by_inner;
};

// Distance of a pixel from a rim in units of the blur, positive outside, and its derivative by the
// blur's logarithm. Blur makes a curved edge recede toward its centre by half of sigma^2 over the
// radius of curvature.
struct RimDistance {
  Float8 d, by_log_blur;
};

ROUNDEL_INLINE RimDistance rim_distance(const PhotometricModel& m, const PlanePoint& p,
                                        const Float8& pixels_per_unit, float rim,
                                        float dark_outward) {
  // The curvature of the rim's image: a circle seen at a slant is flat at its near and far side.
  const Float8 shrink = p.grad_x0 * p.grad_y1 - p.grad_x1 * p.grad_y0;
  const Float8 squeezed = pixels_per_unit * pixels_per_unit * pixels_per_unit * (1 / rim);
  const Float8 curvature = shrink * shrink * squeezed;
  // The radius does not grow evenly along the normal where the image cuts across circles.
  const Float8 across = along_and_across(p);
  const Float8 first = (p.radius - rim) * pixels_per_unit;
  const Float8 uneven = 0.5F * across * across * squeezed;
  const Float8 recession = (0.5F * m.blur) * curvature;
  const Float8 straight = (first + uneven * first * first - dark_outward * m.shift) * (1 / m.blur);
  return {straight + recession, recession - straight};
}

ROUNDEL_INLINE Expected outer_rim(const PhotometricModel& m, const PlanePoint& p) {
  const Float8 pixels_per_unit = 1 / slope_along(p, p.cosine, p.sine);
  const RimDistance rim = rim_distance(m, p, pixels_per_unit, 1.0F, 1.0F);
  const Edge edge = edge_profile(rim.d);
  const Float8 by_pixel = edge.slope * (1 / m.blur), zero = splat(0);
  return {edge.value, by_pixel * pixels_per_unit,   zero,
          -by_pixel,  edge.slope * rim.by_log_blur, zero};
}

ROUNDEL_INLINE Expected plain_centre(const PhotometricModel& m, const PlanePoint& p) {
  const Float8 pixels_per_unit = 1 / slope_along(p, p.cosine, p.sine);
  const RimDistance rim = rim_distance(m, p, pixels_per_unit, m.inner, -1.0F);
  const Edge edge = edge_profile(-rim.d);
  const Float8 by_pixel = edge.slope * (1 / m.blur), by_unit = by_pixel * pixels_per_unit;
  return {edge.value, -by_unit, splat(0), -by_pixel, -edge.slope * rim.by_log_blur, by_unit};
}

// How the ring's teeth look along the arc, without its rims; distances in units of the blur.
struct Teeth {
  Float8 value;                      // share of the bright level
  Float8 by_arc, by_shift, by_blur;  // by a distance along the arc, the shift, the blur's logarithm
};

// Adds the border of two half-teeth. `d` is the distance from it into the half-tooth at hand,
// `step` the colour beyond it less the colour on this side, `forward` +1 where the border lies at a
// larger angle. Dark grows over bright: a border moves away from its darker side.
ROUNDEL_INLINE void add_border(const PhotometricModel& m, const Float8& distance,
                               const Float8& step, float forward, Teeth& teeth) {
  const float shift = m.shift / m.blur;
  const Float8 d = distance + step * shift;
  const Edge edge = edge_profile(-d);
  const Float8 height = step * edge.slope;
  teeth.value += step * edge.value;
  teeth.by_arc += forward * height;
  teeth.by_shift -= step * height;
  teeth.by_blur += height * (d - step * shift);
}

ROUNDEL_INLINE Teeth teeth_along(const PhotometricModel& m, const PlanePoint& p,
                                 const Float8& pixels_per_arc, const Float8& across) {
  const float halves = static_cast<float>(m.halves);
  const Float8 position = simd::turn_of(p.x, p.y) * halves;
  Int8 k = __builtin_convertvector(position, Int8);
  k = k >= m.halves ? k - m.halves : k;
  const Float8 within = position - __builtin_convertvector(k, Float8);
  const auto colour_at = [&](std::size_t neighbour) {
    const Int8 word = Int8{} + m.colours[neighbour];
    return __builtin_convertvector((word >> k) & 1, Float8);
  };
  const float half_angle = 6.2831853F / halves;
  const Float8 blurs_per_arc = p.radius * pixels_per_arc * (1 / m.blur);
  // What the pixel's own gradient gets wrong for a border some angle away.
  const Float8 askew = across * pixels_per_arc * pixels_per_arc;
  // Distance to a straight border: the sine, by its series (the angle is below one and a half
  // half-teeth).
  const auto distance = [&](const Float8& angle, float forward) {
    const Float8 a2 = angle * angle;
    const Float8 sine = angle * (1 + a2 * (-1 / 6.0F + a2 * (1 / 120.0F + a2 * (-1 / 5040.0F))));
    return blurs_per_arc * sine * (1 + forward * askew * angle);
  };
  const Float8 colour = colour_at(2);
  const Float8 to_before = within * half_angle, to_after = (1 - within) * half_angle;
  Teeth teeth{colour, splat(0), splat(0), splat(0)};
  add_border(m, distance(to_before, -1), colour_at(1) - colour, -1, teeth);
  add_border(m, distance(to_after, 1), colour_at(3) - colour, 1, teeth);
  // The borders behind those show only where teeth are narrow.
  constexpr float kFar = 3.5F;  // blurs
  if (simd::any(blurs_per_arc * half_angle < kFar)) {
    add_border(m, distance(to_before + half_angle, -1), colour_at(0) - colour_at(1), -1, teeth);
    add_border(m, distance(to_after + half_angle, 1), colour_at(4) - colour_at(3), 1, teeth);
  }
  return teeth;
}

ROUNDEL_INLINE Expected code_ring(const PhotometricModel& m, const PlanePoint& p) {
  const Float8 pixels_per_unit = 1 / slope_along(p, p.cosine, p.sine);
  const Float8 pixels_per_arc = 1 / slope_along(p, -p.sine, p.cosine);
  const Float8 across = along_and_across(p);
  const RimDistance inner = rim_distance(m, p, pixels_per_unit, m.inner, -1.0F);
  const RimDistance outer = rim_distance(m, p, pixels_per_unit, float(kCodeOuterRatio), -1.0F);
  const Edge centre = edge_profile(-inner.d), ring = edge_profile(-outer.d);
  const Teeth teeth = teeth_along(m, p, pixels_per_arc, across);

  const float per_blur = 1 / m.blur;
  const Float8 centre_part = 1 - ring.value * teeth.value;
  const Float8 ring_part = (1 - centre.value) * teeth.value;
  const Float8 tooth_part = (1 - centre.value) * ring.value;
  // Where rims and borders do not cross at right angles in the image, blur mixes them otherwise
  // than a product does (the bivariate normal distribution, to first order in the correlation).
  const Float8 askew = across * pixels_per_unit * pixels_per_arc * teeth.by_arc *
                       (centre.slope * ring.value - ring.slope * (1 - centre.value));
  Expected e{};
  e.bright = centre.value + tooth_part * teeth.value + askew;
  const Float8 by_pixel = -(centre.slope * centre_part + ring.slope * ring_part) * per_blur;
  e.by_radius = by_pixel * pixels_per_unit;
  e.by_arc = teeth.by_arc * tooth_part * pixels_per_arc * per_blur;
  e.by_shift = by_pixel + teeth.by_shift * tooth_part * per_blur;
  e.by_blur = -(centre.slope * inner.by_log_blur * centre_part +
                ring.slope * outer.by_log_blur * ring_part) +
              teeth.by_blur * tooth_part;
  e.by_inner = splat(0);
  return e;
}

template <typename Model>
ROUNDEL_INLINE void add_pixels(const PhotometricModel& m, const PixelColumns& pixels,
                               PhotometricSums& sums, const Model& expect) {
  constexpr int kCount = kPhotometricUnknowns;
  std::array<Float8, kCount*(kCount + 1) / 2> matrix{};
  std::array<Float8, kCount> right{};
  Float8 squares = splat(0), weights = splat(0);
  for (int i = 0; i < pixels.count; i += simd::kLanes) {
    const auto load = [i](const float* from) {
      Float8 v;
      __builtin_memcpy(&v, from + i, sizeof v);
      return v;
    };
    const PlanePoint p = plane_point(m, load(pixels.x), load(pixels.y));
    const Expected e = expect(p);
    const Float8 light = 1 + m.slope_x * p.x + m.slope_y * p.y;
    const Float8 print = m.dark + m.contrast * e.bright;
    const Float8 residual = load(pixels.grey) - light * print;
    const Float8 size = simd::abs(residual);
    const Float8 trust =
        simd::select(size > m.robust_scale, m.robust_scale / (size + 1e-9F), splat(1));
    const Float8 weight = load(pixels.weight) * simd::select(size > m.outlier, splat(0), trust);

    const Float8 gain = light * m.contrast;
    const Float8 by_x = gain * (e.by_radius * p.cosine - e.by_arc * p.sine);
    const Float8 by_y = gain * (e.by_radius * p.sine + e.by_arc * p.cosine);
    // What a pixel sees when its point of the marker rises out of the plane: it moves toward the
    // eye.
    const float per_height = 1 / m.eye[2];
    const Float8 by_rise = (by_x * (m.eye[0] - p.x) + by_y * (m.eye[1] - p.y)) * per_height;
    std::array<Float8, kCount> row{};
    row[kMoveX] = -by_x;
    row[kMoveY] = -by_y;
    row[kMoveZ] = by_rise;
    row[kTurnX] = p.y * by_rise;
    row[kTurnY] = -p.x * by_rise;
    row[kTurnZ] = p.y * by_x - p.x * by_y;
    row[kDark] = light;
    row[kContrast] = light * e.bright;
    row[kSlopeX] = p.x * print;
    row[kSlopeY] = p.y * print;
    row[kBlur] = gain * e.by_blur;
    row[kShift] = gain * e.by_shift;
    row[kInner] = gain * e.by_inner;
    std::size_t at = 0;
    for (std::size_t r = 0; r < kCount; ++r) {
      const Float8 weighted = weight * row[r];
      for (std::size_t c = 0; c <= r; ++c, ++at) matrix[at] += weighted * row[c];
      right[r] += weighted * residual;
    }
    squares += weight * residual * residual;
    weights += weight;
  }
  for (std::size_t k = 0; k < matrix.size(); ++k) sums.normal_matrix[k] += simd::sum(matrix[k]);
  for (std::size_t k = 0; k < right.size(); ++k) sums.right_side[k] += simd::sum(right[k]);
  sums.squares += simd::sum(squares);
  sums.weights += simd::sum(weights);
}

ROUNDEL_INLINE void add_outer(const PhotometricModel& m, const PixelColumns& pixels,
                              PhotometricSums& sums) {
  add_pixels(
      m, pixels,
      sums, [&](const PlanePoint& p) __attribute__((always_inline)) { return outer_rim(m, p); });
}

ROUNDEL_INLINE void add_inner(const PhotometricModel& m, const PixelColumns& pixels,
                              PhotometricSums& sums) {
  if (m.halves > 0) {
    add_pixels(
        m, pixels,
        sums, [&](const PlanePoint& p) __attribute__((always_inline)) { return code_ring(m, p); });
  } else {
    add_pixels(
        m, pixels, sums, [&](const PlanePoint& p) __attribute__((always_inline)) {
          return plain_centre(m, p);
        });
  }
}

using Kernel = void (*)(const PhotometricModel&, const PixelColumns&, PhotometricSums&);
struct Kernels {
  Kernel outer, inner;
};

void add_outer_baseline(const PhotometricModel& m, const PixelColumns& p, PhotometricSums& s) {
  add_outer(m, p, s);
}
void add_inner_baseline(const PhotometricModel& m, const PixelColumns& p, PhotometricSums& s) {
  add_inner(m, p, s);
}

#if defined(__x86_64__)
// Without fused multiply-add, which would round otherwise than the baseline.
__attribute__((target("avx2"))) void add_outer_avx2(const PhotometricModel& m,
                                                    const PixelColumns& p, PhotometricSums& s) {
  add_outer(m, p, s);
}
__attribute__((target("avx2"))) void add_inner_avx2(const PhotometricModel& m,
                                                    const PixelColumns& p, PhotometricSums& s) {
  add_inner(m, p, s);
}
#endif

constexpr Kernels kBaseline{add_outer_baseline, add_inner_baseline};

Kernels best_kernels() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2")) return {add_outer_avx2, add_inner_avx2};
#endif
  return kBaseline;
}

const Kernels& kernels(VectorUnit unit) {
  static const Kernels best = best_kernels();
  return unit == VectorUnit::kBest ? best : kBaseline;
}

}  // namespace

void add_outer_pixels(const PhotometricModel& model, const PixelColumns& pixels,
                      PhotometricSums& sums, VectorUnit unit) {
  kernels(unit).outer(model, pixels, sums);
}

void add_inner_pixels(const PhotometricModel& model, const PixelColumns& pixels,
                      PhotometricSums& sums, VectorUnit unit) {
  kernels(unit).inner(model, pixels, sums);
}

}  // namespace roundel
