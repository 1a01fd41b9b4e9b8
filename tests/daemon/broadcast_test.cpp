#include "daemon/broadcast.hpp"

#include <doctest/doctest.h>

#include "tests/private_network.hpp"
#include "tests/sample_markers.hpp"
#include "tests/temporary_directory.hpp"
#include "transport/clock.hpp"
#include "transport/lcm_url.hpp"
#include "transport/subscriber.hpp"

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
  LcmSettings copies = settings("memq://");
  copies.copies = {"udpm://10.0.0.1:7667", "memq://"};
  CHECK_THROWS_WITH_AS(Broadcast(copies, "camera"), doctest::Contains("\"memq://\" is no network"),
                       LcmUrlError);
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

TEST_CASE("every copy gets every message, and one that can't be sent disturbs no other") {
  if (!multicast_is_private()) return;
  Subscriber group("udpm://239.255.76.72:7674", "ROUNDEL");
  Subscriber robot("udpm://239.255.76.73:7675", "ROUNDEL");
  LcmSettings copies = settings("udpm://239.255.76.72:7674");
  // The last one has no route.
  copies.copies = {"udpm://127.0.0.1:7675", "udpm://192.0.2.1:7676"};
  Broadcast broadcast(copies, "camera");
  for (std::int64_t number = 0; number < 3; ++number) {
    broadcast.publish(sample_information(number), sample_markers(20));
    for (Subscriber* subscriber : {&group, &robot}) {
      const ReceivedFrame* const frame = subscriber->next_frame(std::chrono::seconds(10));
      REQUIRE(frame != nullptr);
      CHECK(frame->header.frame == number);
      CHECK(frame->markers.size() == 20);
    }
    broadcast.retry(monotonic_ns() + number * 1'000'000'000);
  }
  CHECK(broadcast.unsent_frames() == 0);
}

TEST_CASE("an interface that is not there is waited for") {
  LcmSettings elsewhere = settings("udpm://239.255.76.72:7674");
  elsewhere.interface_name = "nosuch0";
  Broadcast broadcast(elsewhere, "camera");
  CHECK_FALSE(broadcast.is_open());
  broadcast.publish(sample_information(), {});
  CHECK(broadcast.unsent_frames() == 1);
}
