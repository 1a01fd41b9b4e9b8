#pragma once

#include <vector>

namespace roundel::bench {

// The Quade test for complete block designs, as in the paper ([P] section 5): do treatments
// (systems) differ over blocks (poses)? Differences in a block count by the block's range.
struct QuadeResult {
  double f = 0;        // statistic, F-distributed with k - 1 and (n - 1)(k - 1) degrees of freedom
  int blocks = 0;      // n
  int treatments = 0;  // k
  std::vector<double> rank_sums;  // weighted, one a treatment; the smallest has the smallest values
  double spread = 0;              // standard error of the difference of two rank sums

  // Two-sided p value that treatments i and j do not differ, with Sidak's correction for
  // `comparisons` made. The t distribution's degrees of freedom are in the hundreds here: the
  // normal one is used.
  double p_value(std::size_t i, std::size_t j, int comparisons) const;
};

// values[block][treatment]; all blocks have the same size, at least 2, and there are at least 2.
QuadeResult quade_test(const std::vector<std::vector<double>>& values);

}  // namespace roundel::bench
