#include "core/shadow_edge.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/bilinear.hpp"

namespace roundel {

namespace {

constexpr int kOnMargin = 64, kInCentre = 8;  // samples
constexpr std::size_t kSamples = kOnMargin + kInCentre + 1;
constexpr double kMarginRadius = 1.15, kCentreRadius = 0.17;

constexpr double kMaxLight = 0.85;  // what is less of a shadow is left to the slope of the light
constexpr double kMinLight = 0.15;  // what is darker is something else
constexpr std::size_t kFewest = 6;  // samples on either side
constexpr double kEven = 0.2;       // spread of either side, share of the difference between them
constexpr int kAngles = 36;
constexpr double kPenumbraPx = 1.5;  // what the lens makes of the edge, to either side

struct Sample {
  Eigen::Vector2d place;
  double light = 0;
};

double median(const Sample* from, std::size_t count) {
  return from[count / 2].light;
}

}  // namespace

std::optional<ShadowEdge> find_shadow_edge(const LumaView& frame, const PlaneProjection& projection,
                                           const ResponseCurve& response) {
  std::array<Sample, kSamples> samples;
  std::size_t count = 0;
  const auto take = [&](double x, double y) {
    const Eigen::Vector2d p = projection.pixel(x, y);
    if (!can_interpolate(frame, p.x(), p.y())) return;
    samples[count++] = {p, response.light(interpolate(frame, p.x(), p.y()))};
  };
  take(0, 0);
  for (int i = 0; i < kOnMargin + kInCentre; ++i) {
    const bool on_margin = i < kOnMargin;
    const double turn = on_margin ? double(i) / kOnMargin : double(i - kOnMargin) / kInCentre;
    const double radius = on_margin ? kMarginRadius : kCentreRadius;
    const double angle = 2 * std::numbers::pi * turn;
    take(radius * std::cos(angle), radius * std::sin(angle));
  }
  if (count < kSamples / 2) return std::nullopt;

  // Dark ones first; the widest gap of the light parts them.
  const auto end = samples.begin() + static_cast<std::ptrdiff_t>(count);
  std::sort(samples.begin(), end,
            [](const Sample& a, const Sample& b) { return a.light < b.light; });
  std::size_t shaded = kFewest;
  double widest = 0;
  for (std::size_t i = kFewest; i + kFewest <= count; ++i) {
    const double gap = samples[i].light - samples[i - 1].light;
    if (gap > widest) {
      widest = gap;
      shaded = i;
    }
  }
  const double shade = median(samples.data(), shaded);
  const double lit = median(samples.data() + shaded, count - shaded);
  ShadowEdge edge;
  edge.light = shade / std::max(lit, 1e-9);
  if (edge.light > kMaxLight || edge.light < kMinLight) return std::nullopt;
  const auto spread = [&](std::size_t from, std::size_t to) {
    const std::size_t quarter = (to - from) / 4;
    return samples[to - 1 - quarter].light - samples[from + quarter].light;
  };
  if (std::max(spread(0, shaded), spread(shaded, count)) > kEven * (lit - shade)) {
    return std::nullopt;
  }

  // The direction along which all shaded ones lie farthest beyond all lit ones; samples on the very
  // edge are neither.
  const double low = shade + 0.3 * (lit - shade), high = shade + 0.7 * (lit - shade);
  double best = -1e9;
  for (int i = 0; i < kAngles; ++i) {
    const double angle = 2 * std::numbers::pi * i / kAngles;
    const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
    double lit_to = -1e9, shaded_from = 1e9;
    for (std::size_t k = 0; k < count; ++k) {
      const double along = direction.dot(samples[k].place);
      if (samples[k].light > high) lit_to = std::max(lit_to, along);
      if (samples[k].light < low) shaded_from = std::min(shaded_from, along);
    }
    if (shaded_from - lit_to > best) {
      best = shaded_from - lit_to;
      edge.into_shadow = direction;
      edge.lit_to = lit_to;
      edge.shaded_from = shaded_from;
    }
  }
  if (best < -kPenumbraPx) return std::nullopt;
  const double between = (edge.lit_to + edge.shaded_from) / 2;
  edge.lit_to = std::min(edge.lit_to, between) - kPenumbraPx;
  edge.shaded_from = std::max(edge.shaded_from, between) + kPenumbraPx;
  return edge;
}

}  // namespace roundel
