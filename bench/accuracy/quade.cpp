#include "bench/accuracy/quade.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace roundel::bench {

namespace {

// Ranks from 1, ties share their mean.
std::vector<double> ranks_of(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<double> ranks(values.size());
  for (std::size_t first = 0; first < order.size();) {
    std::size_t last = first;
    while (last + 1 < order.size() && values[order[last + 1]] == values[order[first]]) ++last;
    const double rank = 1 + 0.5 * static_cast<double>(first + last);
    for (std::size_t i = first; i <= last; ++i) ranks[order[i]] = rank;
    first = last + 1;
  }
  return ranks;
}

}  // namespace

QuadeResult quade_test(const std::vector<std::vector<double>>& values) {
  QuadeResult result;
  result.blocks = static_cast<int>(values.size());
  result.treatments = static_cast<int>(values.front().size());
  const double n = result.blocks, k = result.treatments;

  std::vector<double> ranges;
  for (const auto& block : values) {
    const auto [low, high] = std::minmax_element(block.begin(), block.end());
    ranges.push_back(*high - *low);
  }
  const std::vector<double> weights = ranks_of(ranges);
  result.rank_sums.assign(values.front().size(), 0);
  double total = 0;  // of the squared weighted ranks
  for (std::size_t b = 0; b < values.size(); ++b) {
    const std::vector<double> ranks = ranks_of(values[b]);
    for (std::size_t t = 0; t < ranks.size(); ++t) {
      const double s = weights[b] * (ranks[t] - 0.5 * (k + 1));
      result.rank_sums[t] += s;
      total += s * s;
    }
  }
  double between = 0;
  for (const double sum : result.rank_sums) between += sum * sum / n;
  const double rest = std::max(total - between, 1e-12 * total);  // 0 if all blocks agree
  result.f = (n - 1) * between / rest;
  result.spread = std::sqrt(2 * n * rest / ((n - 1) * (k - 1)));
  return result;
}

double QuadeResult::p_value(std::size_t i, std::size_t j, int comparisons) const {
  const double t = std::abs(rank_sums[i] - rank_sums[j]) / spread;
  const double p = std::erfc(t / std::sqrt(2.0));
  return -std::expm1(comparisons * std::log1p(-std::min(p, 1.0)));
}

}  // namespace roundel::bench
