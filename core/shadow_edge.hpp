#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/luma_view.hpp"
#include "core/plane_projection.hpp"
#include "core/response_curve.hpp"

namespace roundel {

// The straight edge of a shadow across a marker, in pixels.
struct ShadowEdge {
  Eigen::Vector2d into_shadow = Eigen::Vector2d::UnitX();  // unit vector
  // Up to where along it, from pixel (0, 0), all is in the light, and from where in the shadow.
  double lit_to = 0, shaded_from = 0;
  double light = 1;  // in the shadow, share of that beside it
};

// By the marker's white margin and centre, which are of one paper. Nothing where all of it is in
// the same light, or where light and shade are not parted by a line.
std::optional<ShadowEdge> find_shadow_edge(const LumaView& frame, const PlaneProjection& projection,
                                           const ResponseCurve& response);

}  // namespace roundel
