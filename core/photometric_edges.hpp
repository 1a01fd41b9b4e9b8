#pragma once

#include "core/photometric_kernel.hpp"
#include "core/simd.hpp"

// How bright the model expects a pixel to be, many pixels at once: edges of circles and teeth in
// the marker's plane, seen through perspective and blur (METHOD.md section 6).
namespace roundel::photometric {

using simd::IntOf;
using simd::splat;

// The normal distribution function: its slope times a polynomial, which costs no division; absolute
// error below 1.1e-6.
template <typename V>
struct Normal {
  V tail, slope;  // of -|x|
};

template <typename V>
ROUNDEL_INLINE Normal<V> normal(const V& size) {
  const V x = simd::min<V>(size, splat<V>(4.8F));
  const V x2 = x * x, x4 = x2 * x2;
  const V slope = 0.39894228F * simd::exp_minus<V>(0.5F * x2);
  const V low = (1.25331162F - x * 0.99983343F) + x2 * (0.624850129F - x * 0.325791768F);
  const V high = (0.140744955F - x * 0.04718715F) + x2 * (0.0110286414F - x * 0.00154253781F);
  return {slope * (low + x4 * (high + x4 * 9.50091322e-05F)), slope};
}

// How bright a straight edge looks, by the distance into its bright side in blurs, and the first
// and second derivative. The second one is that by the blur's logarithm as well: blur is diffusion.
template <typename V>
struct Edge {
  V value, slope, bend;
};

// A pixel in the marker's plane.
template <typename V>
struct PlanePoint {
  V x, y, radius, cosine, sine;
  V radius_u, radius_v;  // gradient of the radius in the image, plane units a pixel
  V arc_u, arc_v;        // gradient of the way along the circle
};

template <typename V>
ROUNDEL_INLINE PlanePoint<V> plane_point(const PhotometricModel& m, const V& nx, const V& ny) {
  PlanePoint<V> p{};
  const V depth = 1 / (m.at[2] + m.by_x[2] * nx + m.by_y[2] * ny);
  p.x = (m.at[0] + m.by_x[0] * nx + m.by_y[0] * ny) * depth;
  p.y = (m.at[1] + m.by_x[1] * nx + m.by_y[1] * ny) * depth;
  const V square = p.x * p.x + p.y * p.y + 1e-18F;
  p.radius = simd::sqrt<V>(square);
  const V per_radius = p.radius * (1 / square);
  p.cosine = p.x * per_radius;
  p.sine = p.y * per_radius;
  // Gradients of the plane's coordinates in the image.
  const V xu = (m.by_u[0] - p.x * m.by_u[2]) * depth, xv = (m.by_v[0] - p.x * m.by_v[2]) * depth;
  const V yu = (m.by_u[1] - p.y * m.by_u[2]) * depth, yv = (m.by_v[1] - p.y * m.by_v[2]) * depth;
  p.radius_u = p.cosine * xu + p.sine * yu;
  p.radius_v = p.cosine * xv + p.sine * yv;
  p.arc_u = p.cosine * yu - p.sine * xu;
  p.arc_v = p.cosine * yv - p.sine * xv;
  return p;
}

// An edge as it lies in the image: its scale and what the blur is across and along it.
template <typename V>
struct Direction {
  V pixels;                // a unit of the plane across the edge, in pixels
  V per_pixel;             // blurs a pixel, across
  V along;                 // variance of the blur along the edge over its deviation across
  V stretch_u, stretch_d;  // d(log of the blur across) by the unknowns
  // What of the blur is no Gaussian, in blurs: half the width of the box that pixel and motion
  // make, and the deviation of the rest. Only worked out for boxed edges.
  V box, rest;
};

// A pixel's square sees an edge through two boxes as wide as the edge's normal is long along u and
// v, motion through a third one. One box takes their place, with their kurtosis; the variance that
// it leaves goes to the Gaussian.
template <typename V>
ROUNDEL_INLINE void add_box(const PhotometricModel& m, const V& u, const V& across,
                            Direction<V>& e) {
  constexpr float kLeastRest = 0.03F;                                // of the variance
  const V moved = 12 * m.blur * m.blur * (across - (1 - m.motion));  // square of its width
  const V square = simd::sqrt<V>(0.5F + 0.5F * u * u + moved * moved);
  const V variance =
      simd::min<V>(square * e.per_pixel * e.per_pixel * (1 / 12.0F), splat<V>(1 - kLeastRest));
  e.box = simd::sqrt<V>(3 * variance);
  e.rest = simd::sqrt<V>(1 - variance);
}

template <bool kBoxed, typename V>
ROUNDEL_INLINE Direction<V> direction(const PhotometricModel& m, const V& grad_u, const V& grad_v) {
  Direction<V> e{};
  const V uu = grad_u * grad_u, vv = grad_v * grad_v;
  const V square = uu + vv, difference = uu - vv, product = 2 * grad_u * grad_v;
  // Both divisions and both roots at a time: a processor waits for each.
  const V stretched = square + m.stretch_u * difference + m.stretch_d * product;
  const V per_square = 1 / square, per_across = square / stretched;
  e.pixels = simd::sqrt<V>(per_square);
  const V sharpness = simd::sqrt<V>(per_across);
  const V u = difference * per_square, d = product * per_square;
  const V across = stretched * per_square;  // over the mean variance
  e.per_pixel = sharpness * (1 / m.blur);
  e.along = (m.blur * (2 - across)) * sharpness;
  e.stretch_u = 0.5F * u * per_across;
  e.stretch_d = 0.5F * d * per_across;
  if constexpr (kBoxed) add_box(m, u, across, e);
  return e;
}

template <bool kBoxed, typename V>
ROUNDEL_INLINE Edge<V> edge_profile(const Direction<V>& e, const V& d) {
  if constexpr (kBoxed) {
    // The integral of the normal distribution function is max(x, 0) plus something even.
    const V per_rest = 1 / e.rest, per_width = 0.5F / e.box;
    const V a = (d + e.box) * per_rest, b = (d - e.box) * per_rest;
    const V size_a = simd::abs<V>(a), size_b = simd::abs<V>(b);
    const Normal<V> at_a = normal<V>(size_a), at_b = normal<V>(size_b);
    const V even = (at_a.slope - size_a * at_a.tail) - (at_b.slope - size_b * at_b.tail);
    const V straight = simd::max<V>(a, splat<V>(0)) - simd::max<V>(b, splat<V>(0));
    const V below_a = simd::select<V>(a > 0, 1 - at_a.tail, at_a.tail);
    const V below_b = simd::select<V>(b > 0, 1 - at_b.tail, at_b.tail);
    return {(straight + even) * e.rest * per_width, (below_a - below_b) * per_width,
            (at_a.slope - at_b.slope) * per_rest * per_width};
  } else {
    const Normal<V> at = normal<V>(simd::abs<V>(d));
    return {simd::select<V>(d > 0, 1 - at.tail, at.tail), at.slope, -d * at.slope};
  }
}

// What the model expects of a pixel, and its derivatives.
template <typename V>
struct Expected {
  V bright;             // share of the bright level
  V by_radius, by_arc;  // by an outward, a counter-clockwise shift of the pixel, plane units
  V by_shift, by_blur, by_stretch_u, by_stretch_d, by_inner;
};

// Distance of a pixel from a rim in blurs, positive outside, and what of it is recession: that
// grows as the blur's variance; where just the blur across the rim grows, what is along it is the
// less for it.
template <typename V>
struct RimDistance {
  V d, recession;
};

template <typename V>
ROUNDEL_INLINE RimDistance<V> rim_distance(const PhotometricModel& m, const PlanePoint<V>& p,
                                           const Direction<V>& e, float rim, float dark_outward) {
  // Blur makes a curved edge recede toward its centre by half of its variance along the edge over
  // the radius of curvature. A circle seen at a slant is flat at its near and far side.
  const V shrink = p.radius_u * p.arc_v - p.radius_v * p.arc_u;
  const V squeezed = e.pixels * e.pixels * e.pixels * (1 / rim);
  const V recession = 0.5F * e.along * shrink * shrink * squeezed;
  // The radius does not grow evenly along the normal where the image cuts across circles.
  const V across = p.radius_u * p.arc_u + p.radius_v * p.arc_v;
  const V first = (p.radius - rim) * e.pixels;
  const V uneven = 0.5F * across * across * squeezed;
  const V straight = (first + uneven * first * first - dark_outward * m.shift) * e.per_pixel;
  return {straight + recession, recession};
}

template <bool kBoxed, typename V>
ROUNDEL_INLINE Expected<V> outer_rim(const PhotometricModel& m, const PlanePoint<V>& p) {
  const Direction<V> e = direction<kBoxed, V>(m, p.radius_u, p.radius_v);
  const RimDistance<V> rim = rim_distance<V>(m, p, e, 1.0F, 1.0F);
  const Edge<V> edge = edge_profile<kBoxed, V>(e, rim.d);
  const V by_pixel = edge.slope * e.per_pixel;
  Expected<V> x{};
  x.bright = edge.value;
  x.by_radius = by_pixel * e.pixels;
  x.by_shift = -by_pixel;
  const V receding = 2 * rim.recession * edge.slope;
  x.by_blur = edge.bend + receding;
  const V by_across = edge.bend - receding;
  x.by_stretch_u = by_across * e.stretch_u;
  x.by_stretch_d = by_across * e.stretch_d;
  return x;
}

template <bool kBoxed, typename V>
ROUNDEL_INLINE Expected<V> plain_centre(const PhotometricModel& m, const PlanePoint<V>& p) {
  const Direction<V> e = direction<kBoxed, V>(m, p.radius_u, p.radius_v);
  const RimDistance<V> rim = rim_distance<V>(m, p, e, m.inner, -1.0F);
  const Edge<V> edge = edge_profile<kBoxed, V>(e, -rim.d);
  const V by_pixel = edge.slope * e.per_pixel;
  Expected<V> x{};
  x.bright = edge.value;
  x.by_inner = by_pixel * e.pixels;
  x.by_radius = -x.by_inner;
  x.by_shift = -by_pixel;
  const V receding = 2 * rim.recession * edge.slope;
  x.by_blur = edge.bend - receding;
  const V by_across = edge.bend + receding;
  x.by_stretch_u = by_across * e.stretch_u;
  x.by_stretch_d = by_across * e.stretch_d;
  return x;
}

// How the ring's teeth look along the arc, without its rims; distances in blurs.
template <typename V>
struct Teeth {
  V value;                      // share of the bright level
  V by_arc, by_shift, by_blur;  // by a distance along the arc, the shift, the blur's logarithm
};

// Adds the border of two half-teeth. `distance` is that from it into the half-tooth at hand, `step`
// the colour beyond it less the colour on this side, `forward` +1 where the border lies at a larger
// angle. Dark grows over bright: a border moves away from its darker side.
template <bool kBoxed, typename V>
ROUNDEL_INLINE void add_border(const Direction<V>& e, const V& shift, const V& distance,
                               const V& step, float forward, Teeth<V>& teeth) {
  const Edge<V> edge = edge_profile<kBoxed, V>(e, -(distance + step * shift));
  const V height = step * edge.slope;
  teeth.value += step * edge.value;
  teeth.by_arc += forward * height;
  teeth.by_shift -= step * height;
  teeth.by_blur += step * edge.bend;
}

template <bool kBoxed, typename V>
ROUNDEL_INLINE Teeth<V> teeth_along(const PhotometricModel& m, const PlanePoint<V>& p,
                                    const Direction<V>& e, const V& across) {
  const float halves = static_cast<float>(m.halves);
  const V position = simd::turn_of<V>(p.cosine, p.sine) * halves;
  IntOf<V> k = __builtin_convertvector(position, IntOf<V>);
  k = k >= m.halves ? k - m.halves : k;
  const V within = position - __builtin_convertvector(k, V);
  const auto colour_at = [&](std::size_t neighbour) {
    const IntOf<V> word = IntOf<V>{} + m.colours[neighbour];
    return __builtin_convertvector((word >> k) & 1, V);
  };
  const float half_angle = 6.2831853F / halves;
  const V blurs_per_arc = p.radius * e.pixels * e.per_pixel;
  // What the pixel's own gradient gets wrong for a border some angle away.
  const V askew = across * e.pixels * e.pixels;
  // Distance to a straight border: the sine, by its series (the angle is below one and a half
  // half-teeth).
  const auto distance = [&](const V& angle, float forward) {
    const V a2 = angle * angle;
    const V sine = angle * (1 + a2 * (-1 / 6.0F + a2 * (1 / 120.0F + a2 * (-1 / 5040.0F))));
    return blurs_per_arc * sine * (1 + forward * askew * angle);
  };
  const V shift = m.shift * e.per_pixel;
  const V colour = colour_at(2), before = colour_at(1), after = colour_at(3);
  const V to_before = within * half_angle, to_after = (1 - within) * half_angle;
  Teeth<V> teeth{colour, splat<V>(0), splat<V>(0), splat<V>(0)};
  add_border<kBoxed, V>(e, shift, distance(to_before, -1), before - colour, -1, teeth);
  add_border<kBoxed, V>(e, shift, distance(to_after, 1), after - colour, 1, teeth);
  // The borders behind those show only where teeth are narrow.
  constexpr float kFar = 3.0F;  // blurs
  const IntOf<V> narrow = blurs_per_arc * half_angle < kFar;
  if (simd::any(narrow)) {
    // Pixel by pixel, so that it does not depend on how many are worked on at once.
    const V step_before = simd::select<V>(narrow, colour_at(0) - before, splat<V>(0));
    const V step_after = simd::select<V>(narrow, colour_at(4) - after, splat<V>(0));
    add_border<kBoxed, V>(e, shift, distance(to_before + half_angle, -1), step_before, -1, teeth);
    add_border<kBoxed, V>(e, shift, distance(to_after + half_angle, 1), step_after, 1, teeth);
  }
  return teeth;
}

template <bool kBoxed, typename V>
ROUNDEL_INLINE Expected<V> code_ring(const PhotometricModel& m, const PlanePoint<V>& p) {
  const Direction<V> rim = direction<kBoxed, V>(m, p.radius_u, p.radius_v);
  const Direction<V> border = direction<kBoxed, V>(m, p.arc_u, p.arc_v);
  const V across = p.radius_u * p.arc_u + p.radius_v * p.arc_v;
  const RimDistance<V> inner = rim_distance<V>(m, p, rim, m.inner, -1.0F);
  const RimDistance<V> outer = rim_distance<V>(m, p, rim, float(kCodeOuterRatio), -1.0F);
  const Edge<V> centre = edge_profile<kBoxed, V>(rim, -inner.d);
  const Edge<V> ring = edge_profile<kBoxed, V>(rim, -outer.d);
  const Teeth<V> teeth = teeth_along<kBoxed, V>(m, p, border, across);

  const V centre_part = 1 - ring.value * teeth.value;
  const V ring_part = (1 - centre.value) * teeth.value;
  const V tooth_part = (1 - centre.value) * ring.value;
  // Blur mixes a rim and a border otherwise than a product does where it is not the same across
  // both: they do not cross at right angles in the image, or motion stretches it askew to them. The
  // bivariate normal distribution, to first order in the correlation.
  const V mixed_u = p.radius_u * p.arc_u - p.radius_v * p.arc_v;
  const V mixed_d = p.radius_u * p.arc_v + p.radius_v * p.arc_u;
  const V by_correlation =
      (rim.pixels * border.pixels) * ((m.blur * rim.per_pixel) * (m.blur * border.per_pixel)) *
      (teeth.by_arc * (centre.slope * ring.value - ring.slope * (1 - centre.value)));
  const V askew = (across + m.stretch_u * mixed_u + m.stretch_d * mixed_d) * by_correlation;
  // A rim's curvature is seen together with the teeth: the rim recedes by the square of what the
  // blur spreads along it, which a pixel aside of a border sees more of; and a border some way
  // along the rim is not square to it, which counts twice as much the other way.
  const V bent = teeth.by_blur * (ring.slope * outer.recession * (1 - centre.value) -
                                  centre.slope * inner.recession * ring.value);
  Expected<V> x{};
  x.bright = centre.value + tooth_part * teeth.value + askew + bent;
  const V by_pixel = -(centre.slope * centre_part + ring.slope * ring_part) * rim.per_pixel;
  const V receding =
      2 * (centre.slope * inner.recession * centre_part + ring.slope * outer.recession * ring_part);
  const V widening = centre.bend * centre_part + ring.bend * ring_part;
  const V rims_by_blur = widening - receding, rims_by_across = widening + receding;
  const V teeth_by_blur = teeth.by_blur * tooth_part;
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
