#pragma once

#include <cmath>

#include "core/marker.hpp"

namespace roundel {

// Concentric shares of an ellipse, cut by image rows.
class EllipseRows {
 public:
  explicit EllipseRows(const Ellipse& e) : u_(e.u) {
    const double c = std::cos(e.angle), s = std::sin(e.angle);
    const double aa = 1 / (e.a * e.a), bb = 1 / (e.b * e.b);
    square_ = c * c * aa + s * s * bb;
    per_square_ = 1 / square_;
    mixed_ = c * s * (aa - bb);
    constant_ = s * s * aa + c * c * bb;
  }

  struct Span {
    double u0, u1;  // empty when u1 < u0
  };

  // What the row `dv` below the centre has inside the ellipse shrunk to `share`.
  Span inside(double dv, double share) const {
    const double b = mixed_ * dv;
    const double root = b * b - square_ * (constant_ * dv * dv - share * share);
    if (share <= 0 || root < 0) return {u_, u_ - 1};
    const double half = std::sqrt(root) * per_square_, middle = u_ - b * per_square_;
    return {middle - half, middle + half};
  }

  // How far below and above the centre it reaches, at share 1.
  double half_height() const {
    return std::sqrt(square_ / (square_ * constant_ - mixed_ * mixed_));
  }

 private:
  double u_, square_ = 0, per_square_ = 0, mixed_ = 0, constant_ = 0;
};

}  // namespace roundel
