#include "core/marker_search.hpp"

#include <algorithm>
#include <cmath>

namespace roundel {

namespace {

// A row through the bright centre is as wide as the marker there; a marker tilted by 75 degrees and
// lying across is four times as high.
constexpr double kMaxBoxToExtent = 4.5;

// Edges must stand out of the noise of an averaged 2 x 2 block over some fifty pixels.
constexpr double kNoiseFactor = 3.5;

}  // namespace

MarkerSearch::MarkerSearch(const DetectorParameters& parameters)
    : parameters_(parameters), finder_(parameters) {
  // Two rows through the bright centre, so that one spoilt by a tooth does no harm.
  const double centre_height = kPlainInnerRatioMin * parameters.min_diameter_px;
  smallest_spacing_ = std::clamp(static_cast<int>(centre_height / 2), 1, 8);
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

bool MarkerSearch::is_claimed(int u, int v) const {
  const RowHead& head = rows_[static_cast<std::size_t>(v)];
  if (head.stamp != stamp_) return false;
  for (std::int32_t i = head.first; i >= 0; i = claims_[static_cast<std::size_t>(i)].next_in_row) {
    const Claim& claim = claims_[static_cast<std::size_t>(i)];
    if (u >= claim.u0 && u <= claim.u1) return true;
  }
  return false;
}

void MarkerSearch::claim_segment() {
  for (const Run& span : finder_.row_spans()) {
    RowHead& head = rows_[static_cast<std::size_t>(span.v)];
    if (head.stamp != stamp_) head = {stamp_, -1};
    claims_.push_back({span.u0, span.u1, head.first});
    head.first = static_cast<std::int32_t>(claims_.size() - 1);
  }
}

Verdict MarkerSearch::examine(const LumaView& frame, int u, int v, int threshold, int max_extent) {
  const int limit = std::min(parameters_.max_diameter_px, max_extent);
  const Verdict verdict = finder_.examine(frame, u, v, threshold, {limit, limit});
  if (verdict == Verdict::kAccepted) claim_segment();
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
      const int max_extent = static_cast<int>(kMaxBoxToExtent * seed.extent) + 4;
      if (examine(frame, seed.u, v, seed.threshold, max_extent) == Verdict::kAccepted) {
        found.push_back(finder_.segment());
      }
    }
  }
}

}  // namespace roundel
