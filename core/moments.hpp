#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "core/marker.hpp"

namespace roundel {

// Sums of pixel coordinates over a set of pixels, relative to an origin near them. Exact integers:
// for regions of up to 4096 pixels across nothing overflows.
struct Moments {
  std::int64_t n = 0, su = 0, sv = 0, suu = 0, suv = 0, svv = 0;

  // Adds the pixels (u0 ... u1, v), both ends included, coordinates relative to the origin.
  void add_run(int u0, int u1, int v);
  Moments operator-(const Moments& other) const;
};

// The ellipse around a mean whose area has this covariance, both in pixels: semi-axes are twice the
// square roots of the covariance's eigenvalues. Nothing for a line or a point.
std::optional<Ellipse> ellipse_of(const Eigen::Vector2d& mean, double cuu, double cuv, double cvv);

// The ellipse with the moments' centre, axes and direction ([P] 3.1). Pixels are unit squares, not
// points, so the covariance gets 1/12 more on its diagonal (METHOD.md section 2). Nothing for fewer
// than three pixels or a line.
std::optional<Ellipse> moment_ellipse(const Moments& moments, int origin_u, int origin_v);

}  // namespace roundel
