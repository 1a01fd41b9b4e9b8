#pragma once

#include <array>
#include <cmath>
#include <cstddef>

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

  // What the row `dv` below the centre has inside the ellipse shrunk to each of the shares.
  template <std::size_t kShares>
  std::array<Span, kShares> inside(double dv, const std::array<double, kShares>& shares) const {
    const double b = mixed_ * dv, middle = u_ - b * per_square_;
    const double full = b * b - square_ * constant_ * dv * dv;
    std::array<Span, kShares> spans{};
    for (std::size_t i = 0; i < kShares; ++i) {
      const double root = shares[i] > 0 ? full + square_ * shares[i] * shares[i] : -1;
      const double half = root < 0 ? -0.5 : std::sqrt(root) * per_square_;
      spans[i] = {middle - half, middle + half};
    }
    return spans;
  }
  Span inside(double dv, double share) const { return inside(dv, std::array{share})[0]; }

  // How far below and above the centre it reaches, at share 1.
  double half_height() const {
    return std::sqrt(square_ / (square_ * constant_ - mixed_ * mixed_));
  }

 private:
  double u_, square_ = 0, per_square_ = 0, mixed_ = 0, constant_ = 0;
};

}  // namespace roundel
