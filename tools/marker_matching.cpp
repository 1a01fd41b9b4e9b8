#include "tools/marker_matching.hpp"

#include <algorithm>
#include <cmath>

namespace roundel {

std::vector<std::optional<std::size_t>> match_markers(std::span<const MarkerTruth> truth,
                                                      std::span<const Marker> reported,
                                                      double within_px) {
  struct Pair {
    double distance_px;
    std::size_t truth, reported;
  };
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (truth[i].kind == MarkerKind::Disc) {
      continue;
    }
    for (std::size_t k = 0; k < reported.size(); ++k) {
      const double distance = std::hypot(reported[k].u - truth[i].u, reported[k].v - truth[i].v);
      if (distance <= within_px) {  // never for a marker without an image, which is NaN
        pairs.push_back({distance, i, k});
      }
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const Pair& a, const Pair& b) { return a.distance_px < b.distance_px; });
  std::vector<std::optional<std::size_t>> matches(reported.size());
  std::vector<bool> taken(truth.size());
  for (const Pair& pair : pairs) {
    if (!taken[pair.truth] && !matches[pair.reported]) {
      taken[pair.truth] = true;
      matches[pair.reported] = pair.truth;
    }
  }
  return matches;
}

}  // namespace roundel
