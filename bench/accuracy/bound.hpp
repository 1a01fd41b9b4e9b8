#pragma once

#include <optional>

#include "bench/common/print.hpp"
#include "core/covariance.hpp"

namespace roundel::bench {

// The Cramer-Rao bound of a marker's pose: the smallest covariance that an unbiased estimator can
// have who sees the picture of this print once, under the experiment's noise and rounding, and has
// to find out the pose, the two grey levels of the print and the blur; of the plate's outer edge he
// learns nothing, because its size is nobody's business. Position in metres, camera
// axes; rotation in radians, marker axes. Where a print shows no turn about its normal (`has_yaw`
// false), that variance is 0. Nothing where the picture does not determine the pose.
//
// It is local: it knows nothing of the other pose of an ambiguous view, and near frontal views,
// where the tilt acts on the picture in second order only, errors are smaller than it.
std::optional<PoseCovariance> cramer_rao_bound(const Experiment& experiment, const Print& print,
                                               const PlacedMarker& marker, bool has_yaw);

}  // namespace roundel::bench
