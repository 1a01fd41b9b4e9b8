#include "core/marker_search.hpp"

#include <algorithm>
#include <cmath>

#include "core/ellipse_rows.hpp"
#include "core/rounding.hpp"

namespace roundel {

namespace {

// An ellipse's box is wider than its chord through the middle when it lies askew: by 2.05 for a
// marker tilted by 75 degrees at the worst angle. Chords a little off the middle are shorter.
constexpr double kMaxBoxToChord = 2.4;

// A region that outgrew a seed's limits is tried again only if another row allows it as much more,
// or takes as much less for dark, as a share of the contrast. The row through a marker's middle
// allows 1.17 times what the most askew one needs.
constexpr double kLimitGrowth = 1.10;
constexpr int kThresholdShare = 8;

// A marker's column is at most four times as long as its row when it is tilted by 75 degrees; from
// the middle of the bright run either way it is less than three quarters of that.
constexpr int kMaxReachToChord = 3;
constexpr int kReachSlack = 8;  // pixels

// A ring of 0.2 of the diameter, seen at that tilt, against the row's length.
constexpr int kThinnestRing = 24;

// Edges must stand out of the noise of an averaged 2 x 2 block over some fifty pixels.
constexpr double kNoiseFactor = 3.5;

// A column, read from a pixel on up or down.
class ColumnWalk {
 public:
  ColumnWalk(const LumaView& frame, int u, int v, int direction, int threshold, int reach)
      : pixel_(frame.row(v) + u * frame.pixel_stride),
        stride_(direction * frame.row_stride),
        length_(std::min(reach, direction > 0 ? frame.height - 1 - v : v)),
        threshold_(threshold) {}

  // First place at or after `start` whose colour is not the given one; the end if there is none.
  // Goes by steps that no ring of the size looked for falls through, then back to the very edge.
  int change(int start, bool dark, int step) const {
    int i = start;
    while (i < length_ && is_dark(i) == dark) i += step;
    if (i >= length_ && (step == 1 || is_dark(length_ - 1) == dark)) return length_;
    i = std::min(i, length_ - 1);
    while (i > start && is_dark(i - 1) != dark) --i;
    return i;
  }
  int length() const { return length_; }

 private:
  bool is_dark(int i) const { return pixel_[i * stride_] < threshold_; }

  const std::uint8_t* pixel_;
  std::ptrdiff_t stride_;
  int length_, threshold_;
};

// A seed's row looks like a marker's; so must the column through the middle of its bright run,
// before anything is filled: this turns down most of what is bright on a darker floor. Returns the
// length of the column from outer edge to outer edge, 0 when it does not fit.
int fitting_column(const LumaView& frame, const Seed& seed, int max_diameter) {
  const int reach = std::min(max_diameter, kMaxReachToChord * seed.extent + kReachSlack);
  const int step = std::max(1, seed.extent / kThinnestRing);
  const ColumnWalk up(frame, seed.bright_u, seed.v, -1, seed.threshold, reach);
  const ColumnWalk down(frame, seed.bright_u, seed.v, 1, seed.threshold, reach);
  // Up first: these rows have been read before, those below are yet to come into the cache.
  const int up_bright = up.change(0, false, step);
  if (up_bright == up.length()) return 0;
  const int up_end = up.change(up_bright, true, step);
  if (up_end == up.length()) return 0;
  const int down_bright = down.change(0, false, step);
  if (down_bright == down.length()) return 0;
  const int down_end = down.change(down_bright, true, step);
  if (down_end == down.length()) return 0;
  if (!is_marker_pattern(up_end - up_bright, up_bright + down_bright, down_end - down_bright)) {
    return 0;
  }
  return up_end + down_end;
}

}  // namespace

MarkerSearch::MarkerSearch(const DetectorParameters& parameters)
    : parameters_(parameters), finder_(parameters) {
  // A row pair through the bright centre of the smallest marker.
  const double centre_height = kPlainInnerRatioMin * 0.75 * parameters.min_diameter_px;
  smallest_spacing_ = std::clamp(static_cast<int>(std::lround(centre_height)) - 1, 1, 8);
}

void MarkerSearch::begin(const LumaView& frame) {
  if (rows_.size() < static_cast<std::size_t>(frame.height)) {
    rows_.assign(static_cast<std::size_t>(frame.height), RowHead{});
    stamp_ = 0;
  }
  if (++stamp_ == 0) {
    std::fill(rows_.begin(), rows_.end(), RowHead{});
    stamp_ = 1;
  }
  claims_.clear();
  given_up_.clear();
  contrast_ = std::max(parameters_.min_contrast,
                       static_cast<int>(std::lround(kNoiseFactor * estimate_noise(frame))));
}

template <typename Wanted>
bool MarkerSearch::has_claim(int u, int v, const Wanted& wanted) const {
  const RowHead& head = rows_[static_cast<std::size_t>(v)];
  if (head.stamp != stamp_) return false;
  for (std::int32_t i = head.first; i >= 0; i = claims_[static_cast<std::size_t>(i)].next_in_row) {
    const Claim& claim = claims_[static_cast<std::size_t>(i)];
    if (u >= claim.u0 && u <= claim.u1 && wanted(claim)) return true;
  }
  return false;
}

bool MarkerSearch::is_owned(int u, int v, Owner owner) const {
  return has_claim(u, v, [owner](const Claim& claim) { return claim.owner == owner; });
}

bool MarkerSearch::is_hopeless(const Seed& seed, const RegionFiller::Limits& limits) const {
  return has_claim(seed.u, seed.v, [&](const Claim& claim) {
    if (claim.owner != Owner::kTooLarge) return false;
    const GivenUp& fill = given_up_[static_cast<std::size_t>(claim.fill)];
    return seed.threshold + contrast_ / kThresholdShare >= fill.threshold &&
           limits.max_width <= kLimitGrowth * fill.limits.max_width &&
           limits.max_height <= kLimitGrowth * fill.limits.max_height;
  });
}

void MarkerSearch::claim(const Run& run, Owner owner, std::int32_t fill) {
  RowHead& head = rows_[static_cast<std::size_t>(run.v)];
  if (head.stamp != stamp_) head = {stamp_, -1};
  claims_.push_back({run.u0, run.u1, head.first, owner, fill});
  head.first = static_cast<std::int32_t>(claims_.size() - 1);
}

void MarkerSearch::claim_segment() {
  for (const Run& span : finder_.row_spans()) claim(span, Owner::kMarker);
}

void MarkerSearch::claim(const Ellipse& outline, int frame_height) {
  const EllipseRows rows(outline);
  const double reach = rows.half_height();
  const int first = std::max(0, ceil_int(outline.v - reach));
  const int last = std::min(frame_height - 1, floor_int(outline.v + reach));
  for (int v = first; v <= last; ++v) {
    const EllipseRows::Span span = rows.inside(v - outline.v, 1);
    if (span.u1 < span.u0) continue;
    claim({v, floor_int(span.u0), ceil_int(span.u1)}, Owner::kMarker);
  }
}

Verdict MarkerSearch::examine(const LumaView& frame, int u, int v, int threshold,
                              const RegionFiller::Limits& limits) {
  const Verdict verdict = finder_.examine(frame, u, v, threshold, limits);
  if (verdict != Verdict::kAccepted) return verdict;
  // A blurred edge pixel just outside of a claimed marker leads into it again.
  const Ellipse& ellipse = finder_.segment().ellipse;
  if (is_claimed(static_cast<int>(std::lround(ellipse.u)),
                 static_cast<int>(std::lround(ellipse.v)))) {
    return Verdict::kKnown;
  }
  claim_segment();
  return verdict;
}

void MarkerSearch::search(const LumaView& frame, const Box& area, int spacing, std::size_t limit,
                          std::vector<Segment>& found) {
  scanner_.start(frame, area, spacing, contrast_, parameters_.max_diameter_px);
  while (scanner_.next()) {
    for (const Seed& seed : scanner_.seeds()) {
      if (found.size() >= limit) return;
      if (is_claimed(seed.u, seed.v) || is_claimed(seed.bright_u, seed.v)) continue;
      if (is_owned(seed.u, seed.v, Owner::kNoMarker)) continue;
      const int column = fitting_column(frame, seed, parameters_.max_diameter_px);
      if (column == 0) continue;
      const RegionFiller::Limits limits{static_cast<int>(kMaxBoxToChord * seed.extent) + 4,
                                        static_cast<int>(kMaxBoxToChord * column) + 4};
      if (is_hopeless(seed, limits)) continue;
      const Verdict verdict = examine(frame, seed.u, seed.v, seed.threshold, limits);
      if (verdict == Verdict::kAccepted) {
        found.push_back(finder_.segment());
      } else if (verdict == Verdict::kTooLarge) {
        // Too large for this row's limits; it may be right for another's.
        const auto fill = static_cast<std::int32_t>(given_up_.size());
        given_up_.push_back({seed.threshold, limits});
        finder_.for_each_run([&](const Run& run) { claim(run, Owner::kTooLarge, fill); });
      } else if (verdict != Verdict::kKnown) {
        // Another row would lead to the same region.
        finder_.for_each_run([&](const Run& run) { claim(run, Owner::kNoMarker); });
      }
    }
  }
}

}  // namespace roundel
