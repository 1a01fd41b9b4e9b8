#include "daemon/statistics.hpp"

#include <doctest/doctest.h>

using namespace roundel;

TEST_CASE("a report tells rate, counts and latencies of the frames since the one before") {
  Statistics statistics({0, 10'000'000});
  for (std::int64_t i = 0; i < 30; ++i) {
    const std::int64_t captured = 10'000'000 + 33'333 * i;
    statistics.add({captured,
                    captured + 10'000,
                    captured + 13'000,
                    captured + 13'500,
                    captured + 13'520,
                    {400'000, 80'000, 20'000}},
                   16);
  }
  status_t status{};
  statistics.report({0, 11'000'000}, status);
  CHECK(status.uptime == 1'000'000);
  CHECK(status.frames == 30);
  CHECK(status.frame_rate == doctest::Approx(30));
  CHECK(status.markers == 16);
  CHECK(status.arrival.p50 == doctest::Approx(10'000).epsilon(0.03));
  CHECK(status.reading.p50 == doctest::Approx(3000).epsilon(0.03));
  CHECK(status.tracking.p99 == doctest::Approx(500).epsilon(0.03));
  CHECK(status.following.p50 == doctest::Approx(400).epsilon(0.03));
  CHECK(status.searching.p90 == doctest::Approx(80).epsilon(0.03));
  CHECK(status.identifying.max == doctest::Approx(20).epsilon(0.03));
  CHECK(status.publishing.max == doctest::Approx(20).epsilon(0.03));
  CHECK(status.handling.p50 == doctest::Approx(3520).epsilon(0.03));
  CHECK(status.total.p90 == doctest::Approx(13'520).epsilon(0.03));

  statistics.report({0, 12'000'000}, status);
  CHECK(status.uptime == 2'000'000);
  CHECK(status.frames == 30);
  CHECK(status.frame_rate == 0);
  CHECK(status.markers == 0);
  CHECK(status.total.max == 0);
}

TEST_CASE("a session counts its own frames") {
  Statistics statistics({0, 0});
  statistics.add({0, 1, 2, 3, 4, {}}, 1);
  statistics.begin_session();
  statistics.add({0, 1, 2, 3, 4, {}}, 1);
  status_t status{};
  statistics.report({0, 1'000'000}, status);
  CHECK(status.frames == 1);
  CHECK(status.frame_rate == 2);
}

TEST_CASE("two reports at one instant do not divide by zero") {
  Statistics statistics({0, 5});
  status_t status{};
  statistics.report({0, 5}, status);
  CHECK(status.frame_rate == 0);
}
