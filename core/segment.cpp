#include "core/segment.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/rounding.hpp"

namespace roundel {

namespace {

constexpr int kDirections = 16;
constexpr double kMinShortSide = 0.75;  // of the smallest diameter
constexpr double kRingRadius = 0.8;     // middle of the dark ring, share of the outer radius
constexpr double kMarginRadius = 1.13;  // inside the printed white margin
constexpr double kMinMarginGap = 1.5;  // pixels outside the edge, so that blur does not reach there

// A share of the dark ring may be covered by glare or something small.
constexpr int kMinDarkDirections = 13;

// What the pixel grid adds to the area mismatch of a small ellipse, in shares times pixels of the
// shorter semi-axis; noise of a few per cent of the contrast included.
constexpr double kGridCircularity = 0.10;

double plain_area_ratio(double inner_ratio) {
  return (1 - inner_ratio * inner_ratio) / (inner_ratio * inner_ratio);
}

struct EllipseAxes {
  double cos_angle, sin_angle;
  explicit EllipseAxes(const Ellipse& e)
      : cos_angle(std::cos(e.angle)), sin_angle(std::sin(e.angle)) {}
};

// Unit directions; a table, because the levels are taken for every marker of every frame.
const std::array<std::array<double, 2>, kDirections>& directions() {
  static const auto table = [] {
    std::array<std::array<double, 2>, kDirections> made{};
    for (int i = 0; i < kDirections; ++i) {
      const double angle = 2 * std::numbers::pi * (i + 0.5) / kDirections;
      made[static_cast<std::size_t>(i)] = {std::cos(angle), std::sin(angle)};
    }
    return made;
  }();
  return table;
}

// Mean of the middle half of the first `count`, in the order of their size. Ranks are counted, side
// by side, which takes less than sorting does.
double mean_of_middle_half(const std::array<std::uint8_t, kDirections>& list, std::size_t count) {
  using Sixteen = std::uint8_t __attribute__((vector_size(kDirections)));
  Sixteen levels, positions{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15}, ranks{};
  __builtin_memcpy(&levels, list.data(), sizeof levels);
  for (std::size_t i = 0; i < count; ++i) {
    const Sixteen other = Sixteen{} + list[i], place = Sixteen{} + static_cast<std::uint8_t>(i);
    // A comparison that holds is all ones, or -1.
    const Sixteen before = (other < levels) | ((other == levels) & (place < positions));
    ranks -= before;
  }
  const std::size_t quarter = count / 4;
  int sum = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (ranks[i] >= quarter && ranks[i] < count - quarter) sum += levels[i];
  }
  return sum / static_cast<double>(count - 2 * quarter);
}

}  // namespace

std::optional<Levels> measure_levels(const LumaView& frame, const Ellipse& ellipse,
                                     int min_contrast) {
  const EllipseAxes axes(ellipse);
  std::array<std::uint8_t, kDirections> ring{}, margin{};
  std::size_t ring_count = 0, margin_count = 0;
  const auto sample = [&](double along_a, double along_b, auto& list, std::size_t& count) {
    const double u = ellipse.u + along_a * axes.cos_angle - along_b * axes.sin_angle;
    const double v = ellipse.v + along_a * axes.sin_angle + along_b * axes.cos_angle;
    const int pu = nearest_int(u), pv = nearest_int(v);
    if (frame.contains(pu, pv)) list[count++] = frame.at(pu, pv);
  };
  const double margin_a = std::max(kMarginRadius * ellipse.a, ellipse.a + kMinMarginGap);
  const double margin_b = std::max(kMarginRadius * ellipse.b, ellipse.b + kMinMarginGap);
  for (const auto& [cosine, sine] : directions()) {
    sample(kRingRadius * ellipse.a * cosine, kRingRadius * ellipse.b * sine, ring, ring_count);
    sample(margin_a * cosine, margin_b * sine, margin, margin_count);
  }
  if (ring_count < kDirections || margin_count < kDirections / 2) return std::nullopt;
  // The middle half of each list: neither glare on the ring nor a neighbour in the margin counts.
  Levels levels;
  levels.dark = mean_of_middle_half(ring, ring_count);
  levels.bright = mean_of_middle_half(margin, margin_count);
  if (levels.contrast() < min_contrast) return std::nullopt;
  const auto dark = std::count_if(ring.begin(), ring.end(),
                                  [&](std::uint8_t level) { return level < levels.middle(); });
  if (dark < kMinDarkDirections) return std::nullopt;
  return levels;
}

SegmentFinder::SegmentFinder(const DetectorParameters& parameters) : parameters_(parameters) {
  // A code's ring is white to one half, whatever its word: that lies between the plain markers'
  // extremes, which are accepted beside codes (arena corners).
  const double tolerance = 1 + parameters.area_ratio_tolerance;
  min_area_ratio_ = plain_area_ratio(kPlainInnerRatioMax) / tolerance;
  max_area_ratio_ = plain_area_ratio(kPlainInnerRatioMin) * tolerance;
}

Verdict SegmentFinder::examine(const LumaView& frame, int u, int v, int threshold,
                               const RegionFiller::Limits& limits) {
  Verdict verdict = examine_once(frame, u, v, threshold, limits);
  if (verdict != Verdict::kAccepted) return verdict;
  // The seed's levels are a first guess; the marker's own ones decide where its edge is. One repeat
  // settles it: the levels are taken away from edges and hardly depend on the outline.
  const int own = static_cast<int>(std::lround(segment_.levels.middle()));
  constexpr double kSameThreshold = 0.04;  // share of the contrast: a few hundredths of a pixel
  if (std::abs(own - threshold) <= kSameThreshold * segment_.levels.contrast()) return verdict;
  if (examine_once(frame, u, v, own, limits) == Verdict::kAccepted) return Verdict::kAccepted;
  return examine_once(frame, u, v, threshold, limits);
}

Verdict SegmentFinder::examine_once(const LumaView& frame, int u, int v, int threshold,
                                    const RegionFiller::Limits& limits) {
  switch (filler_.fill(frame, u, v, threshold, limits)) {
    case FillResult::kNoSeed:
      return Verdict::kNotDark;
    case FillResult::kTouchesEdge:
      return Verdict::kCutOff;
    case FillResult::kTooLarge:
      return Verdict::kTooLarge;
    case FillResult::kComplete:
      break;
  }
  const Region& region = filler_.region();
  const int short_side = std::min(region.box.width(), region.box.height());
  if (short_side < kMinShortSide * parameters_.min_diameter_px) return Verdict::kTooSmall;

  // An ellipse fills pi/4 of its box when upright; one of aspect 1:4 lying at 45 degrees, 0.37 of
  // it.
  constexpr double kMinBoxFill = 0.30, kMaxBoxFill = std::numbers::pi / 4;
  const double box_area = double(region.box.width()) * region.box.height();
  const double filled_area = static_cast<double>(region.filled.n);
  const double grid_slack = region.box.width() + region.box.height();  // half a pixel all around
  if (filled_area < kMinBoxFill * box_area || filled_area > kMaxBoxFill * box_area + grid_slack) {
    return Verdict::kBoxFill;
  }

  const int centre_u = (region.box.u0 + region.box.u1) / 2;
  const int centre_v = (region.box.v0 + region.box.v1) / 2;
  if (frame.at(centre_u, centre_v) < threshold) return Verdict::kCentreNotBright;

  const Moments bright = region.filled - region.dark;
  if (bright.n < 4) return Verdict::kAreaRatio;
  const double ratio = static_cast<double>(region.dark.n) / static_cast<double>(bright.n);
  // Blur eats the bright centre of a small marker: half a pixel around it may be missing.
  const double bright_edge = std::sqrt(std::numbers::pi * static_cast<double>(bright.n));
  const double small_slack = 1 + bright_edge / static_cast<double>(bright.n);
  if (ratio < min_area_ratio_ / small_slack || ratio > max_area_ratio_ * small_slack) {
    return Verdict::kAreaRatio;
  }

  const auto ellipse = moment_ellipse(region.filled, region.origin_u, region.origin_v);
  if (!ellipse) return Verdict::kNotElliptic;
  const auto inner = moment_ellipse(bright, region.origin_u, region.origin_v);
  if (!inner) return Verdict::kNotElliptic;
  const auto off_centre = [&](double offset, int extent) {
    return std::abs(offset) >
           parameters_.concentricity_tolerance_px + parameters_.concentricity_tolerance * extent;
  };
  if (off_centre(inner->u - ellipse->u, region.box.width()) ||
      off_centre(inner->v - ellipse->v, region.box.height())) {
    return Verdict::kNotConcentric;
  }

  const double ellipse_area = std::numbers::pi * ellipse->a * ellipse->b;
  const double tolerance = parameters_.circularity_tolerance + kGridCircularity / ellipse->b;
  if (std::abs(ellipse_area / filled_area - 1) > tolerance) return Verdict::kNotElliptic;
  if (2 * ellipse->b < kMinShortSide * parameters_.min_diameter_px ||
      2 * std::sqrt(ellipse->a * ellipse->b) < parameters_.min_diameter_px) {
    return Verdict::kTooSmall;
  }
  if (2 * ellipse->a > parameters_.max_diameter_px) return Verdict::kTooLarge;

  const auto levels = measure_levels(frame, *ellipse, parameters_.min_contrast);
  if (!levels) return Verdict::kRingNotClosed;

  segment_.ellipse = *ellipse;
  segment_.inner = *inner;
  segment_.bright_share = static_cast<double>(bright.n) / filled_area;
  segment_.levels = *levels;
  segment_.threshold = threshold;
  segment_.box = region.box;
  return Verdict::kAccepted;
}

}  // namespace roundel
