#pragma once

#include <vector>

namespace roundel::bench {

struct Distribution {
  double mean = 0, median = 0, p99 = 0, worst = 0;
};

// NaN for no values.
double mean_of(const std::vector<double>& values);
Distribution distribution_of(std::vector<double> values);

}  // namespace roundel::bench
