#include "tools/distribution.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace roundel {

std::optional<Distribution::Summary> Distribution::summary() const {
  if (values_.empty()) {
    return std::nullopt;
  }
  std::vector<double> sorted = values_;
  std::sort(sorted.begin(), sorted.end());
  const auto count = static_cast<double>(sorted.size());
  const auto quantile = [&](double share) {
    return sorted[static_cast<std::size_t>(std::ceil(share * count)) - 1];
  };
  return Summary{std::accumulate(sorted.begin(), sorted.end(), 0.0) / count, quantile(0.5),
                 quantile(0.99), sorted.back()};
}

}  // namespace roundel
