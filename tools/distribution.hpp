#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace roundel {

// Values of which mean and exact quantiles are wanted; it keeps them all.
class Distribution {
 public:
  // Quantiles are values that occurred: the smallest that the given share of all do not exceed.
  struct Summary {
    double mean = 0, median = 0, p99 = 0, worst = 0;
  };

  void add(double value) { values_.push_back(value); }
  std::size_t count() const { return values_.size(); }
  std::optional<Summary> summary() const;  // nothing without values

 private:
  std::vector<double> values_;
};

}  // namespace roundel
