#include "bench/accuracy/reliability.hpp"

#include <doctest/doctest.h>

#include "tests/random.hpp"

using namespace roundel::bench;

namespace {

// Readings that are right with the probability stated, plus what the reader is too sure by.
double error_of_a_reader(double too_sure) {
  roundel::test::Random random(5);
  std::vector<Reading> readings;
  for (int i = 0; i < 100'000; ++i) {
    const double stated = random.uniform(0.2, 1);
    readings.push_back({stated, random.uniform(0, 1) < stated - too_sure});
  }
  return expected_calibration_error(reliability_bins(readings, 20));
}

}  // namespace

TEST_CASE("a reader that is right as often as it says has no calibration error") {
  CHECK(error_of_a_reader(0) < 0.01);
}

TEST_CASE("the calibration error is what a reader is too sure by") {
  CHECK(error_of_a_reader(0.1) == doctest::Approx(0.1).epsilon(0.05));
}

TEST_CASE("every reading is in the bin of its probability, certainty in the last one") {
  const auto bins = reliability_bins({{0, false}, {0.24, true}, {0.25, true}, {1, true}}, 4);
  REQUIRE(bins.size() == 4);
  CHECK(bins[0].count == 2);
  CHECK(bins[0].right == 1);
  CHECK(bins[0].mean_probability == doctest::Approx(0.12));
  CHECK(bins[1].count == 1);
  CHECK(bins[2].count == 0);
  CHECK(bins[3].count == 1);
  CHECK(bins[3].high == 1);
}

TEST_CASE("no readings, no calibration error") {
  CHECK(expected_calibration_error(reliability_bins({}, 10)) == 0);
}
