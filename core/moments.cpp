#include "core/moments.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace roundel {

namespace {

// 1 + 4 + ... + k^2; its differences are right for negative k as well.
std::int64_t sum_of_squares(std::int64_t k) {
  return k * (k + 1) * (2 * k + 1) / 6;
}

}  // namespace

void Moments::add_run(int u0, int u1, int v) {
  const std::int64_t count = u1 - u0 + 1;
  const std::int64_t sum = count * (u0 + u1) / 2;
  n += count;
  su += sum;
  sv += count * v;
  suu += sum_of_squares(u1) - sum_of_squares(u0 - 1);
  suv += sum * v;
  svv += count * v * v;
}

Moments Moments::operator-(const Moments& other) const {
  return {n - other.n,     su - other.su,   sv - other.sv,
          suu - other.suu, suv - other.suv, svv - other.svv};
}

std::optional<Ellipse> ellipse_of(const Eigen::Vector2d& mean, double cuu, double cuv, double cvv) {
  const double middle = (cuu + cvv) / 2;
  const double spread = std::hypot((cuu - cvv) / 2, cuv);
  if (!(middle - spread > 0)) return std::nullopt;
  Ellipse ellipse;
  ellipse.u = mean.x();
  ellipse.v = mean.y();
  ellipse.a = 2 * std::sqrt(middle + spread);
  ellipse.b = 2 * std::sqrt(middle - spread);
  ellipse.angle = 0.5 * std::atan2(2 * cuv, cuu - cvv);
  return ellipse;
}

std::optional<Ellipse> moment_ellipse(const Moments& moments, int origin_u, int origin_v) {
  if (moments.n < 3) return std::nullopt;
  const double n = static_cast<double>(moments.n);
  const double mean_u = static_cast<double>(moments.su) / n;
  const double mean_v = static_cast<double>(moments.sv) / n;
  constexpr double kUnitSquare = 1.0 / 12.0;
  const double cuu = static_cast<double>(moments.suu) / n - mean_u * mean_u + kUnitSquare;
  const double cvv = static_cast<double>(moments.svv) / n - mean_v * mean_v + kUnitSquare;
  const double cuv = static_cast<double>(moments.suv) / n - mean_u * mean_v;
  return ellipse_of({origin_u + mean_u, origin_v + mean_v}, cuu, cuv, cvv);
}

}  // namespace roundel
