#pragma once

#include <optional>

#include "core/camera_model.hpp"
#include "core/marker.hpp"
#include "core/pose.hpp"

namespace roundel {

// The image of a marker's outer edge under a pose: the ellipse that has the moments of what it
// encloses, as a segment's has, lens included. Nothing where the marker is not in front of the
// camera or the lens model ends.
std::optional<Ellipse> outline_of(const Pose& pose, double radius_m, const CameraModel& camera);

}  // namespace roundel
