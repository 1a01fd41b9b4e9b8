#include "core/pose.hpp"

#include <algorithm>
#include <cmath>

namespace roundel {

double orientation_error(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  // arccos |a . b| loses half its digits near zero; the vector part of a^-1 b does not.
  const Eigen::Quaterniond relative = a.conjugate() * b;
  return std::atan2(relative.vec().norm(), std::abs(relative.w()));
}

}  // namespace roundel
