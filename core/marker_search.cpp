#include "core/marker_search.hpp"

#include <algorithm>
#include <cmath>

namespace roundel {

namespace {

// An ellipse's box is wider than its chord through the middle when it lies askew: by 2.05 for a
// marker tilted by 75 degrees at the worst angle. Chords a little off the middle are shorter.
constexpr double kMaxBoxToChord = 2.4;

// Edges must stand out of the noise of an averaged 2 x 2 block over some fifty pixels.
constexpr double kNoiseFactor = 3.5;

// Pixels of bright and of the dark after it, going from a bright pixel along a column; dark is 0
// when no bright pixel ends it within `reach` pixels.
struct ColumnWalk {
  int bright = 0, dark = 0;
};

ColumnWalk walk_column(const LumaView& frame, int u, int v, int step, int threshold, int reach) {
  const int length = std::min(reach, step > 0 ? frame.height - 1 - v : v);
  const std::uint8_t* p = frame.row(v) + u * frame.pixel_stride;
  const std::ptrdiff_t stride = step * frame.row_stride;
  int i = 0;
  while (i < length && p[i * stride] >= threshold) ++i;
  const int bright = i;
  while (i < length && p[i * stride] < threshold) ++i;
  return {bright, i < length ? i - bright : 0};
}

// A seed's row looks like a marker's; so must the column through the middle of its bright run,
// before anything is filled: this turns down most of what is bright on a darker floor. Returns the
// length of the column from outer edge to outer edge, 0 when it does not fit.
int fitting_column(const LumaView& frame, const Seed& seed, int reach) {
  const ColumnWalk up = walk_column(frame, seed.bright_u, seed.v, -1, seed.threshold, reach);
  if (up.dark == 0) return 0;
  const ColumnWalk down = walk_column(frame, seed.bright_u, seed.v, 1, seed.threshold, reach);
  if (!is_marker_pattern(up.dark, up.bright + down.bright, down.dark)) return 0;
  return up.dark + up.bright + down.bright + down.dark;
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
  contrast_ = std::max(parameters_.min_contrast,
                       static_cast<int>(std::lround(kNoiseFactor * estimate_noise(frame))));
}

bool MarkerSearch::is_owned(int u, int v, Owner owner) const {
  const RowHead& head = rows_[static_cast<std::size_t>(v)];
  if (head.stamp != stamp_) return false;
  for (std::int32_t i = head.first; i >= 0; i = claims_[static_cast<std::size_t>(i)].next_in_row) {
    const Claim& claim = claims_[static_cast<std::size_t>(i)];
    if (u >= claim.u0 && u <= claim.u1 && claim.owner == owner) return true;
  }
  return false;
}

void MarkerSearch::claim(const Run& run, Owner owner) {
  RowHead& head = rows_[static_cast<std::size_t>(run.v)];
  if (head.stamp != stamp_) head = {stamp_, -1};
  claims_.push_back({run.u0, run.u1, head.first, owner});
  head.first = static_cast<std::int32_t>(claims_.size() - 1);
}

void MarkerSearch::claim_segment() {
  for (const Run& span : finder_.row_spans()) claim(span, Owner::kMarker);
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
  const int u0 = std::max(0, area.u0), u1 = std::min(frame.width - 1, area.u1);
  const int last_v = std::min(frame.height - 2, area.v1);
  for (int v = std::max(0, area.v0); v <= last_v; v += spacing) {
    for (const Seed& seed :
         scanner_.scan(frame, v, u0, u1, contrast_, parameters_.max_diameter_px)) {
      if (found.size() >= limit) return;
      if (is_claimed(seed.u, v) || is_claimed(seed.bright_u, v)) continue;
      if (is_owned(seed.u, v, Owner::kNoMarker)) continue;
      const int column = fitting_column(frame, seed, parameters_.max_diameter_px);
      if (column == 0) continue;
      const RegionFiller::Limits limits{static_cast<int>(kMaxBoxToChord * seed.extent) + 4,
                                        static_cast<int>(kMaxBoxToChord * column) + 4};
      const Verdict verdict = examine(frame, seed.u, v, seed.threshold, limits);
      if (verdict == Verdict::kAccepted) {
        found.push_back(finder_.segment());
      } else if (verdict != Verdict::kTooLarge && verdict != Verdict::kKnown) {
        // Another row would lead to the same region; one too large for this row's limits may be
        // right for another's.
        finder_.for_each_run([&](const Run& run) { claim(run, Owner::kNoMarker); });
      }
    }
  }
}

}  // namespace roundel
