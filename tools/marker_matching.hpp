#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/marker.hpp"
#include "simulator/truth.hpp"

namespace roundel {

// Which of the true markers each reported one is, by the place in the image: the closest pairs
// first, each marker at most once, never further apart than `within_px`. One entry a reported
// marker; nothing where there is no true one. Black discs are no markers.
std::vector<std::optional<std::size_t>> match_markers(std::span<const MarkerTruth> truth,
                                                      std::span<const Marker> reported,
                                                      double within_px);

}  // namespace roundel
