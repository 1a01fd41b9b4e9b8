#include "bench/speed/speed_targets.hpp"

#include <doctest/doctest.h>

#include <sstream>

using namespace roundel::bench;

namespace {

Timing timing(const char* system, const char* frames, double median_us) {
  Timing t;
  t.scene = "floor";
  t.system = system;
  t.frames = frames;
  t.width = 1920;
  t.markers = 7;
  t.us = {median_us, median_us, median_us, median_us};
  return t;
}

std::string table_of(const Timings& timings) {
  std::ostringstream out;
  write_speed_targets(out, timings);
  return out.str();
}

}  // namespace

TEST_CASE("a time below its target meets it, one above misses it") {
  CHECK(table_of({timing("roundel", "following", 140)}).find("1 of 1 targets are met") !=
        std::string::npos);
  CHECK(table_of({timing("roundel", "following", 160)}).find("0 of 1 targets are met") !=
        std::string::npos);
}

TEST_CASE("a ratio is the peer's time over Roundel's in the same scene") {
  const std::string table =
      table_of({timing("roundel", "following", 100), timing("aruco", "any", 45'000)});
  CHECK(table.find("450 ×") != std::string::npos);
  CHECK(table.find("2 of 2 targets are met") != std::string::npos);
}

TEST_CASE("what was not measured is neither met nor missed") {
  CHECK(table_of({}).find("0 of 0 targets are met") != std::string::npos);
}

TEST_CASE("a lost track misses its target whatever the time") {
  Timing drop = timing("roundel", "light drops to a quarter", 100);
  drop.as_wanted = false;
  const std::string table =
      table_of({timing("roundel", "before and after the light drops", 100), drop});
  CHECK(table.find("1 of 2 targets are met") != std::string::npos);
}
