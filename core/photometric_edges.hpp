#pragma once

#include "core/photometric_kernel.hpp"
#include "core/simd.hpp"

// How bright the model expects a pixel to be, eight pixels at once: edges of circles and teeth in
// the marker's plane, seen through perspective and blur (METHOD.md section 6).
namespace roundel::photometric {

using simd::Float8;
using simd::Int8;
using simd::splat;

// The normal distribution function, by Abramowitz and Stegun 26.2.17: absolute error below 1e-7.
struct Normal {
  Float8 tail, slope;  // of -|x|
};

ROUNDEL_INLINE Normal normal(const Float8& size) {
  const Float8 x = simd::min(size, splat(4.8F));
  const Float8 slope = 0.39894228F * simd::exp_minus(0.5F * x * x);
  const Float8 t = 1 / (1 + 0.2316419F * x);
  Float8 tail = -1.821255978F + t * 1.330274429F;
  tail = 1.781477937F + t * tail;
  tail = -0.356563782F + t * tail;
  return {slope * t * (0.319381530F + t * tail), slope};
}

// How bright a straight edge looks, by the distance into its bright side in blurs, and the first
// and second derivative. The second one is that by the blur's logarithm as well: blur is diffusion.
struct Edge {
  Float8 value, slope, bend;
};

// A pixel in the marker's plane.
struct PlanePoint {
  Float8 x, y, radius, cosine, sine;
  Float8 radius_u, radius_v;  // gradient of the radius in the image, plane units a pixel
  Float8 arc_u, arc_v;        // gradient of the way along the circle
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
  const Float8 radius_x = p.cosine * xx + p.sine * yx, radius_y = p.cosine * xy + p.sine * yy;
  const Float8 arc_x = p.cosine * yx - p.sine * xx, arc_y = p.cosine * yy - p.sine * xy;
  p.radius_u = radius_x * s[0] + radius_y * s[2];
  p.radius_v = radius_x * s[1] + radius_y * s[3];
  p.arc_u = arc_x * s[0] + arc_y * s[2];
  p.arc_v = arc_x * s[1] + arc_y * s[3];
  return p;
}

// An edge as it lies in the image: its scale and what the blur is across and along it.
struct Direction {
  Float8 pixels;                // a unit of the plane across the edge, in pixels
  Float8 per_pixel;             // blurs a pixel, across
  Float8 along;                 // variance of the blur along the edge over its deviation across
  Float8 stretch_u, stretch_d;  // d(log of the blur across) by the unknowns
  // What of the blur is no Gaussian, in blurs: half the width of the box that pixel and motion
  // make, and the deviation of the rest. Only worked out for boxed edges.
  Float8 box, rest;
};

// A pixel's square sees an edge through two boxes as wide as the edge's normal is long along u and
// v, motion through a third one. One box takes their place, with their kurtosis; the variance that
// it leaves goes to the Gaussian.
ROUNDEL_INLINE void add_box(const PhotometricModel& m, const Float8& u, const Float8& across,
                            Direction& e) {
  constexpr float kLeastRest = 0.03F;                                     // of the variance
  const Float8 moved = 12 * m.blur * m.blur * (across - (1 - m.motion));  // square of its width
  const Float8 square = simd::sqrt(0.5F + 0.5F * u * u + moved * moved);
  const Float8 variance =
      simd::min(square * e.per_pixel * e.per_pixel * (1 / 12.0F), splat(1 - kLeastRest));
  e.box = simd::sqrt(3 * variance);
  e.rest = simd::sqrt(1 - variance);
}

template <bool kBoxed>
ROUNDEL_INLINE Direction direction(const PhotometricModel& m, const Float8& grad_u,
                                   const Float8& grad_v) {
  Direction e{};
  const Float8 uu = grad_u * grad_u, vv = grad_v * grad_v;
  const Float8 per_square = 1 / (uu + vv);
  e.pixels = simd::sqrt(per_square);
  const Float8 u = (uu - vv) * per_square, d = 2 * grad_u * grad_v * per_square;
  const Float8 across = 1 + m.stretch_u * u + m.stretch_d * d;  // over the mean variance
  const Float8 per_across = 1 / across, sharpness = simd::sqrt(per_across);
  e.per_pixel = sharpness * (1 / m.blur);
  e.along = (m.blur * (2 - across)) * sharpness;
  e.stretch_u = 0.5F * u * per_across;
  e.stretch_d = 0.5F * d * per_across;
  if constexpr (kBoxed) add_box(m, u, across, e);
  return e;
}

template <bool kBoxed>
ROUNDEL_INLINE Edge edge_profile(const Direction& e, const Float8& d) {
  if constexpr (kBoxed) {
    // The integral of the normal distribution function is max(x, 0) plus something even.
    const Float8 per_rest = 1 / e.rest, per_width = 0.5F / e.box;
    const Float8 a = (d + e.box) * per_rest, b = (d - e.box) * per_rest;
    const Float8 size_a = simd::abs(a), size_b = simd::abs(b);
    const Normal at_a = normal(size_a), at_b = normal(size_b);
    const Float8 even = (at_a.slope - size_a * at_a.tail) - (at_b.slope - size_b * at_b.tail);
    const Float8 straight = simd::max(a, splat(0)) - simd::max(b, splat(0));
    const Float8 below_a = simd::select(a > 0, 1 - at_a.tail, at_a.tail);
    const Float8 below_b = simd::select(b > 0, 1 - at_b.tail, at_b.tail);
    return {(straight + even) * e.rest * per_width, (below_a - below_b) * per_width,
            (at_a.slope - at_b.slope) * per_rest * per_width};
  } else {
    const Normal at = normal(simd::abs(d));
    return {simd::select(d > 0, 1 - at.tail, at.tail), at.slope, -d * at.slope};
  }
}

// What the model expects of a pixel, and its derivatives.
struct Expected {
  Float8 bright;             // share of the bright level
  Float8 by_radius, by_arc;  // by an outward, a counter-clockwise shift of the pixel, plane units
  Float8 by_shift, by_blur, by_stretch_u, by_stretch_d, by_inner;
};

// Distance of a pixel from a rim in blurs, positive outside, and what of it is recession: that
// grows as the blur's variance; where just the blur across the rim grows, what is along it is the
// less for it.
struct RimDistance {
  Float8 d, recession;
};

ROUNDEL_INLINE RimDistance rim_distance(const PhotometricModel& m, const PlanePoint& p,
                                        const Direction& e, float rim, float dark_outward) {
  // Blur makes a curved edge recede toward its centre by half of its variance along the edge over
  // the radius of curvature. A circle seen at a slant is flat at its near and far side.
  const Float8 shrink = p.radius_u * p.arc_v - p.radius_v * p.arc_u;
  const Float8 squeezed = e.pixels * e.pixels * e.pixels * (1 / rim);
  const Float8 recession = 0.5F * e.along * shrink * shrink * squeezed;
  // The radius does not grow evenly along the normal where the image cuts across circles.
  const Float8 across = p.radius_u * p.arc_u + p.radius_v * p.arc_v;
  const Float8 first = (p.radius - rim) * e.pixels;
  const Float8 uneven = 0.5F * across * across * squeezed;
  const Float8 straight = (first + uneven * first * first - dark_outward * m.shift) * e.per_pixel;
  return {straight + recession, recession};
}

template <bool kBoxed>
ROUNDEL_INLINE Expected outer_rim(const PhotometricModel& m, const PlanePoint& p) {
  const Direction e = direction<kBoxed>(m, p.radius_u, p.radius_v);
  const RimDistance rim = rim_distance(m, p, e, 1.0F, 1.0F);
  const Edge edge = edge_profile<kBoxed>(e, rim.d);
  const Float8 by_pixel = edge.slope * e.per_pixel;
  Expected x{};
  x.bright = edge.value;
  x.by_radius = by_pixel * e.pixels;
  x.by_shift = -by_pixel;
  const Float8 receding = 2 * rim.recession * edge.slope;
  x.by_blur = edge.bend + receding;
  const Float8 by_across = edge.bend - receding;
  x.by_stretch_u = by_across * e.stretch_u;
  x.by_stretch_d = by_across * e.stretch_d;
  return x;
}

template <bool kBoxed>
ROUNDEL_INLINE Expected plain_centre(const PhotometricModel& m, const PlanePoint& p) {
  const Direction e = direction<kBoxed>(m, p.radius_u, p.radius_v);
  const RimDistance rim = rim_distance(m, p, e, m.inner, -1.0F);
  const Edge edge = edge_profile<kBoxed>(e, -rim.d);
  const Float8 by_pixel = edge.slope * e.per_pixel;
  Expected x{};
  x.bright = edge.value;
  x.by_inner = by_pixel * e.pixels;
  x.by_radius = -x.by_inner;
  x.by_shift = -by_pixel;
  const Float8 receding = 2 * rim.recession * edge.slope;
  x.by_blur = edge.bend - receding;
  const Float8 by_across = edge.bend + receding;
  x.by_stretch_u = by_across * e.stretch_u;
  x.by_stretch_d = by_across * e.stretch_d;
  return x;
}

// How the ring's teeth look along the arc, without its rims; distances in blurs.
struct Teeth {
  Float8 value;                      // share of the bright level
  Float8 by_arc, by_shift, by_blur;  // by a distance along the arc, the shift, the blur's logarithm
};

// Adds the border of two half-teeth. `distance` is that from it into the half-tooth at hand, `step`
// the colour beyond it less the colour on this side, `forward` +1 where the border lies at a larger
// angle. Dark grows over bright: a border moves away from its darker side.
template <bool kBoxed>
ROUNDEL_INLINE void add_border(const Direction& e, const Float8& shift, const Float8& distance,
                               const Float8& step, float forward, Teeth& teeth) {
  const Edge edge = edge_profile<kBoxed>(e, -(distance + step * shift));
  const Float8 height = step * edge.slope;
  teeth.value += step * edge.value;
  teeth.by_arc += forward * height;
  teeth.by_shift -= step * height;
  teeth.by_blur += step * edge.bend;
}

template <bool kBoxed>
ROUNDEL_INLINE Teeth teeth_along(const PhotometricModel& m, const PlanePoint& p, const Direction& e,
                                 const Float8& across) {
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
  const Float8 blurs_per_arc = p.radius * e.pixels * e.per_pixel;
  // What the pixel's own gradient gets wrong for a border some angle away.
  const Float8 askew = across * e.pixels * e.pixels;
  // Distance to a straight border: the sine, by its series (the angle is below one and a half
  // half-teeth).
  const auto distance = [&](const Float8& angle, float forward) {
    const Float8 a2 = angle * angle;
    const Float8 sine = angle * (1 + a2 * (-1 / 6.0F + a2 * (1 / 120.0F + a2 * (-1 / 5040.0F))));
    return blurs_per_arc * sine * (1 + forward * askew * angle);
  };
  const Float8 shift = m.shift * e.per_pixel;
  const Float8 colour = colour_at(2), before = colour_at(1), after = colour_at(3);
  const Float8 to_before = within * half_angle, to_after = (1 - within) * half_angle;
  Teeth teeth{colour, splat(0), splat(0), splat(0)};
  add_border<kBoxed>(e, shift, distance(to_before, -1), before - colour, -1, teeth);
  add_border<kBoxed>(e, shift, distance(to_after, 1), after - colour, 1, teeth);
  // The borders behind those show only where teeth are narrow.
  constexpr float kFar = 3.0F;  // blurs
  if (simd::any(blurs_per_arc * half_angle < kFar)) {
    add_border<kBoxed>(e, shift, distance(to_before + half_angle, -1), colour_at(0) - before, -1,
                       teeth);
    add_border<kBoxed>(e, shift, distance(to_after + half_angle, 1), colour_at(4) - after, 1,
                       teeth);
  }
  return teeth;
}

template <bool kBoxed>
ROUNDEL_INLINE Expected code_ring(const PhotometricModel& m, const PlanePoint& p) {
  const Direction rim = direction<kBoxed>(m, p.radius_u, p.radius_v);
  const Direction border = direction<kBoxed>(m, p.arc_u, p.arc_v);
  const Float8 across = p.radius_u * p.arc_u + p.radius_v * p.arc_v;
  const RimDistance inner = rim_distance(m, p, rim, m.inner, -1.0F);
  const RimDistance outer = rim_distance(m, p, rim, float(kCodeOuterRatio), -1.0F);
  const Edge centre = edge_profile<kBoxed>(rim, -inner.d);
  const Edge ring = edge_profile<kBoxed>(rim, -outer.d);
  const Teeth teeth = teeth_along<kBoxed>(m, p, border, across);

  const Float8 centre_part = 1 - ring.value * teeth.value;
  const Float8 ring_part = (1 - centre.value) * teeth.value;
  const Float8 tooth_part = (1 - centre.value) * ring.value;
  // Blur mixes a rim and a border otherwise than a product does where it is not the same across
  // both: they do not cross at right angles in the image, or motion stretches it askew to them. The
  // bivariate normal distribution, to first order in the correlation.
  const Float8 mixed_u = p.radius_u * p.arc_u - p.radius_v * p.arc_v;
  const Float8 mixed_d = p.radius_u * p.arc_v + p.radius_v * p.arc_u;
  const Float8 by_correlation =
      (rim.pixels * border.pixels) * ((m.blur * rim.per_pixel) * (m.blur * border.per_pixel)) *
      (teeth.by_arc * (centre.slope * ring.value - ring.slope * (1 - centre.value)));
  const Float8 askew = (across + m.stretch_u * mixed_u + m.stretch_d * mixed_d) * by_correlation;
  // A rim's curvature is seen together with the teeth: the rim recedes by the square of what the
  // blur spreads along it, which a pixel aside of a border sees more of; and a border some way
  // along the rim is not square to it, which counts twice as much the other way.
  const Float8 bent = teeth.by_blur * (ring.slope * outer.recession * (1 - centre.value) -
                                       centre.slope * inner.recession * ring.value);
  Expected x{};
  x.bright = centre.value + tooth_part * teeth.value + askew + bent;
  const Float8 by_pixel = -(centre.slope * centre_part + ring.slope * ring_part) * rim.per_pixel;
  const Float8 receding =
      2 * (centre.slope * inner.recession * centre_part + ring.slope * outer.recession * ring_part);
  const Float8 widening = centre.bend * centre_part + ring.bend * ring_part;
  const Float8 rims_by_blur = widening - receding, rims_by_across = widening + receding;
  const Float8 teeth_by_blur = teeth.by_blur * tooth_part;
  x.by_radius = by_pixel * rim.pixels;
  x.by_arc = teeth.by_arc * tooth_part * border.pixels * border.per_pixel;
  x.by_shift = by_pixel + teeth.by_shift * tooth_part * border.per_pixel;
  x.by_blur = rims_by_blur + teeth_by_blur;
  x.by_stretch_u =
      rims_by_across * rim.stretch_u + teeth_by_blur * border.stretch_u + mixed_u * by_correlation;
  x.by_stretch_d =
      rims_by_across * rim.stretch_d + teeth_by_blur * border.stretch_d + mixed_d * by_correlation;
  return x;
}

}  // namespace roundel::photometric
