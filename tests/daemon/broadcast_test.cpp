#include "daemon/broadcast.hpp"

#include <doctest/doctest.h>

#include "tests/sample_markers.hpp"
#include "tests/temporary_directory.hpp"
#include "transport/clock.hpp"
#include "transport/lcm_url.hpp"

using namespace roundel;

namespace {

LcmSettings settings(const std::string& url) {
  LcmSettings settings;
  settings.url = url;
  return settings;
}

}  // namespace

TEST_CASE("settings that can't work are refused at once") {
  CHECK_THROWS_AS(Broadcast(settings("http://x"), "camera"), LcmUrlError);
  CHECK_THROWS_WITH_AS(Broadcast(settings("file:///tmp/a.lcm"), "camera"),
                       doctest::Contains("?mode=w"), LcmUrlError);
  LcmSettings small = settings("memq://");
  small.max_datagram = 200;
  CHECK_THROWS_AS(Broadcast(small, "camera"), std::invalid_argument);
}

TEST_CASE("frames count as unsent as long as LCM can't be opened") {
  // A log file in a folder that does not exist yet stands for a network that is not there.
  Broadcast broadcast(settings("file:///nonexistent/a.lcm?mode=w"), "camera");
  CHECK_FALSE(broadcast.is_open());
  broadcast.publish(sample_information(), sample_markers(3));
  broadcast.publish(status_t{});
  broadcast.retry(monotonic_ns() + 1'000'000'000);
  CHECK_FALSE(broadcast.is_open());
  broadcast.publish(sample_information(), {});
  CHECK(broadcast.unsent_frames() == 2);
}

TEST_CASE("an open broadcast sends") {
  Broadcast broadcast(settings("memq://"), "camera");
  CHECK(broadcast.is_open());
  broadcast.publish(sample_information(), sample_markers(100));
  broadcast.publish(status_t{});
  CHECK(broadcast.unsent_frames() == 0);
}
