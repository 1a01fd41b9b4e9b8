#include "daemon/latency_histogram.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

#include "tests/random.hpp"

using namespace roundel;

TEST_CASE("an empty histogram has zeros everywhere") {
  const LatencyHistogram histogram;
  CHECK(histogram.count() == 0);
  CHECK(histogram.max_us() == 0);
  CHECK(histogram.percentile_us(0.99) == 0);
}

TEST_CASE("percentiles are those of the durations to within three percent") {
  test::Random random(4);
  for (const double scale : {5.0, 300.0, 2e4, 3e6, 1e9}) {
    CAPTURE(scale);
    LatencyHistogram histogram;
    std::vector<std::int64_t> durations;
    for (int i = 0; i < 5000; ++i) {
      durations.push_back(static_cast<std::int64_t>(scale * random.uniform(0, 1)));
      histogram.add(durations.back());
    }
    std::sort(durations.begin(), durations.end());
    for (const double share : {0.01, 0.5, 0.9, 0.99, 1.0}) {
      const auto index = static_cast<std::size_t>(share * 5000.0 - 0.5);
      const auto expected = static_cast<double>(durations[index]);
      CHECK(histogram.percentile_us(share) == doctest::Approx(expected).epsilon(0.03));
    }
    CHECK(histogram.max_us() == durations.back());
    CHECK(histogram.count() == 5000);
  }
}

TEST_CASE("durations beyond all measure are counted without harm") {
  LatencyHistogram histogram;
  for (const std::int64_t duration : {INT64_MIN, std::int64_t{-1}, std::int64_t{0}, INT64_MAX}) {
    histogram.add(duration);
  }
  CHECK(histogram.count() == 4);
  CHECK(histogram.max_us() == INT64_MAX);
  CHECK(histogram.percentile_us(0.5) == 0);
}

TEST_CASE("clearing forgets everything") {
  LatencyHistogram histogram;
  histogram.add(1000);
  histogram.clear();
  histogram.add(10);
  CHECK(histogram.count() == 1);
  CHECK(histogram.percentile_us(1) == 10);
}
