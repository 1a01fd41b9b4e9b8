#include "transport/frame_encoder.hpp"

#include <doctest/doctest.h>

#include <stdexcept>

#include "tests/sample_markers.hpp"
#include "transport/safe_decode.hpp"

using namespace roundel;

TEST_CASE("a frame without markers is one message with zero markers") {
  FrameEncoder encoder("ROUNDEL_FRAME", "ceiling", 1400);
  const auto parts = encoder.encode(sample_information(), {});
  REQUIRE(parts.size() == 1);
  frame_t message;
  REQUIRE(decode(parts[0], message));
  CHECK(message.parts == 1);
  CHECK(message.part == 0);
  CHECK(message.frame_markers == 0);
  CHECK(message.markers.empty());
  CHECK(message.camera == "ceiling");
  CHECK(message.header.frame == 7);
}

TEST_CASE("every datagram of a frame stays within the limit, whatever the limit and the frame") {
  for (const int limit : {512, 600, 1400, 9000, 65000}) {
    FrameEncoder encoder("ROUNDEL_FRAME", "ceiling", limit);
    for (const int count : {0, 1, 3, 8, 9, 12, 100, 1000}) {
      CAPTURE(limit);
      CAPTURE(count);
      const auto markers = sample_markers(count);
      const auto parts = encoder.encode(sample_information(), markers);
      std::size_t largest = 0, seen = 0;
      for (std::size_t i = 0; i < parts.size(); ++i) {
        largest = std::max(largest, parts[i].size() + lcm_overhead("ROUNDEL_FRAME"));
        frame_t message;
        REQUIRE(decode(parts[i], message));
        REQUIRE(message.part == static_cast<int>(i));
        REQUIRE(message.parts == static_cast<int>(parts.size()));
        REQUIRE(message.frame_markers == count);
        REQUIRE(message.first_marker == static_cast<int>(seen));
        for (const marker_t& marker : message.markers) {
          REQUIRE(marker.track == markers[seen].track);
          ++seen;
        }
      }
      CHECK(largest <= static_cast<std::size_t>(limit));
      CHECK(seen == markers.size());
      // No part is sent that would have fitted into the others.
      const auto room = static_cast<std::size_t>(encoder.markers_per_part());
      CHECK(parts.size() == std::max<std::size_t>(1, (markers.size() + room - 1) / room));
    }
  }
}

TEST_CASE("a default datagram holds seven markers") {
  CHECK(FrameEncoder("ROUNDEL_FRAME", "camera", 1400).markers_per_part() == 7);
}

TEST_CASE("LCM puts eight bytes, the channel and a zero in front of a message") {
  CHECK(lcm_overhead("ROUNDEL_FRAME") == 8 + 13 + 1);
}

TEST_CASE("a datagram without room for one marker is refused with the size that is needed") {
  CHECK_THROWS_WITH_AS(FrameEncoder("ROUNDEL_FRAME", "camera", 200),
                       doctest::Contains("no room for a marker; at least"), std::invalid_argument);
  CHECK_THROWS_AS(FrameEncoder("ROUNDEL_FRAME", std::string(400, 'x'), 512), std::invalid_argument);
  CHECK_NOTHROW(FrameEncoder(std::string(40, 'C') + "_FRAME", std::string(64, 'x'), 512));
}
