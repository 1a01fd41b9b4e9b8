#pragma once

#include <array>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "calibration/arena_calibration.hpp"
#include "calibration/arena_collector.hpp"
#include "calibration/arena_pose_fit.hpp"

namespace roundel {

// Why there is no calibration: one sentence for the user, with the numbers.
struct ArenaRefusal : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// A fixed marker that was seen, and where it is said to be.
struct SeenReference {
  StillMarker marker;
  Eigen::Vector3d place;
};

// The rectangle's corners, from the origin on, counter-clockwise.
std::array<Eigen::Vector3d, 4> corner_places(const ArenaRequest& request);

// Residual that a corner may have, metres.
double corner_tolerance(const ArenaRequest& request);

// What a fit leaves of each reference: found minus said, arena x and y, metres.
std::vector<Eigen::Vector2d> residuals(const Pose& arena_in_camera,
                                       std::span<const SeenReference> references);
std::optional<ArenaPoseFit> fit_references(std::span<const SeenReference> references);

// The four outermost of the markers that fit the rectangle best, from the origin on. Plain markers
// are preferred; if there are not four, those with codes count too. Throws ArenaRefusal.
std::vector<SeenReference> outermost_corners(std::span<const StillMarker> still,
                                             const ArenaRequest& request);

// The corners with the given ids. A corner that is not there is left out: anchors may stand in for
// it. Throws ArenaRefusal if the ids do not go round the arena counter-clockwise.
std::vector<SeenReference> named_corners(std::span<const StillMarker> still,
                                         const ArenaRequest& request);

// "3 x 2 m".
std::string size_text(const ArenaRequest& request);

}  // namespace roundel
