#include "daemon/capture/frame_clock.hpp"

#include <doctest/doctest.h>
#include <linux/videodev2.h>

#include <limits>

using namespace roundel;

namespace {

constexpr std::uint32_t kMonotonic = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
constexpr std::int64_t kSecond = 1'000'000;

TimeStamp at(std::int64_t mono_us) {
  return {1'000'000 * kSecond + mono_us, mono_us};
}

}  // namespace

TEST_CASE("a stamp of the driver is put on both clocks, with its source") {
  FrameClock clock;
  const auto start = clock.judge({50'000, kMonotonic | V4L2_BUF_FLAG_TSTAMP_SRC_SOE}, at(80'000));
  REQUIRE(start.has_value());
  CHECK(start->captured.mono_us == 50'000);
  CHECK(start->captured.wall_us == 1'000'000 * kSecond + 50'000);
  CHECK(start->source == StampSource::kStartOfFrame);
  const auto end = clock.judge({60'000, kMonotonic}, at(80'000));
  REQUIRE(end.has_value());
  CHECK(end->source == StampSource::kEndOfFrame);
  CHECK(clock.trusted());
}

TEST_CASE("absurd stamps are refused: the frame gets the time of its arrival") {
  constexpr std::int64_t kNow = 100 * kSecond;
  for (const std::int64_t stamp :
       {kNow + FrameClock::kFutureUs + 1, std::int64_t{0}, std::int64_t{-1},
        std::numeric_limits<std::int64_t>::max(), std::numeric_limits<std::int64_t>::min(),
        kNow - FrameClock::kOldestUs - 1}) {
    CAPTURE(stamp);
    FrameClock clock;
    const auto time = clock.judge({stamp, kMonotonic}, at(kNow));
    REQUIRE(time.has_value());
    CHECK(time->captured.mono_us == kNow);
    CHECK(time->source == StampSource::kArrival);
    CHECK(clock.refused() == 1);
    CHECK_FALSE(clock.trusted());
  }
}

TEST_CASE("stamps of another clock are refused, however right they look") {
  FrameClock clock;
  for (const std::uint32_t flags : {0U, static_cast<std::uint32_t>(V4L2_BUF_FLAG_TIMESTAMP_COPY)}) {
    const auto time = clock.judge({90'000, flags}, at(100'000));
    REQUIRE(time.has_value());
    CHECK(time->source == StampSource::kArrival);
  }
}

TEST_CASE("a stamp that does not rise is refused") {
  FrameClock clock;
  REQUIRE(clock.judge({90'000, kMonotonic}, at(100'000))->source == StampSource::kEndOfFrame);
  CHECK(clock.judge({90'000, kMonotonic}, at(110'000))->source == StampSource::kArrival);
  CHECK(clock.judge({130'000, kMonotonic}, at(140'000))->source == StampSource::kEndOfFrame);
}

TEST_CASE("an old frame is stale where stamps were right so far") {
  FrameClock clock;
  REQUIRE(clock.judge({kSecond, kMonotonic}, at(kSecond + 10)).has_value());
  // The program slept for five seconds while this one waited.
  CHECK_FALSE(clock.judge({kSecond + 33'000, kMonotonic}, at(6 * kSecond)).has_value());
  const auto fresh = clock.judge({6 * kSecond, kMonotonic}, at(6 * kSecond + 10));
  REQUIRE(fresh.has_value());
  CHECK(fresh->source == StampSource::kEndOfFrame);
}

TEST_CASE("frames that are always old mean a wrong clock, not stale frames") {
  FrameClock clock;
  REQUIRE(clock.judge({kSecond, kMonotonic}, at(kSecond + 10)).has_value());
  int stale = 0;
  std::optional<CaptureTime> time;
  for (std::int64_t i = 1; i < 100 && !time; ++i) {
    time = clock.judge({kSecond + i * 33'000, kMonotonic}, at(60 * kSecond + i * 33'000));
    if (!time) ++stale;
  }
  CHECK(stale == FrameClock::kMaxStale);
  REQUIRE(time.has_value());
  CHECK(time->source == StampSource::kArrival);
}
