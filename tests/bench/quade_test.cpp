#include "bench/accuracy/quade.hpp"

#include <doctest/doctest.h>

using namespace roundel::bench;

namespace {

// Five brands of lotion in seven stores: the example of W. J. Conover, Practical Nonparametric
// Statistics, and of R's quade.test, which gives F = 3.8293.
const std::vector<std::vector<double>> kLotions = {
    {5, 4, 7, 10, 12},  {1, 3, 1, 0, 2},      {16, 12, 22, 22, 35}, {5, 4, 3, 5, 4},
    {10, 9, 7, 13, 10}, {19, 18, 28, 37, 58}, {10, 7, 6, 8, 7}};

}  // namespace

TEST_CASE("Quade's statistic is that of the textbook's example") {
  const QuadeResult result = quade_test(kLotions);
  CHECK(result.blocks == 7);
  CHECK(result.treatments == 5);
  CHECK(result.f == doctest::Approx(3.8293).epsilon(1e-4));
}

TEST_CASE("a system that is always better has the smallest rank sum and differs beyond chance") {
  std::vector<std::vector<double>> values;
  for (int i = 0; i < 300; ++i) {
    const double noise = (i * 37 % 101) / 101.0;
    values.push_back({1 + noise, 2.5 - noise, 3 + noise});
  }
  const QuadeResult result = quade_test(values);
  CHECK(result.rank_sums[0] < result.rank_sums[1]);
  CHECK(result.rank_sums[1] < result.rank_sums[2]);
  CHECK(result.p_value(0, 2, 2) < 1e-12);
}

TEST_CASE("equal systems do not differ, and more comparisons raise the p value") {
  std::vector<std::vector<double>> values;
  for (int i = 0; i < 300; ++i) {
    const double a = (i * 37 % 101) / 101.0, b = (i * 53 % 103) / 103.0;
    values.push_back({a, b});
  }
  const QuadeResult result = quade_test(values);
  CHECK(result.p_value(0, 1, 1) > 0.05);
  CHECK(result.p_value(0, 1, 4) > result.p_value(0, 1, 1));
}
