#include "transport/pose_encoder.hpp"

#include <doctest/doctest.h>

#include <string>

#include "tests/sample_markers.hpp"
#include "transport/safe_decode.hpp"

using namespace roundel;

namespace {

std::vector<std::int64_t> selected_tracks(PoseEncoder& encoder,
                                          const std::vector<Marker>& markers) {
  std::vector<std::int64_t> tracks;
  for (const Marker* marker : encoder.select(markers)) tracks.push_back(marker->track);
  return tracks;
}

}  // namespace

TEST_CASE("a single pose carries its marker and its frame's header") {
  PoseEncoder encoder("ARENA");
  const Marker marker = sample_marker(6);
  CHECK(std::string(encoder.channel(marker)) == "ARENA_POSE_7");
  pose_t message;
  const Bytes bytes = encoder.encode(sample_information(9), marker);
  CHECK(bytes.size() + lcm_overhead("ARENA_POSE_7") < 300);
  REQUIRE(decode(bytes, message));
  CHECK(message.header.frame == 9);
  CHECK(message.marker.id == 7);
  CHECK(message.marker.position[0] == 6.125F);
}

TEST_CASE("a channel's number does not leave digits of an earlier one behind") {
  PoseEncoder encoder("ROUNDEL");
  CHECK(std::string(encoder.channel(sample_marker(4079))) == "ROUNDEL_POSE_4080");
  CHECK(std::string(encoder.channel(sample_marker(0))) == "ROUNDEL_POSE_1");
}

TEST_CASE("markers without an id get no channel") {
  PoseEncoder encoder("ROUNDEL");
  auto markers = sample_markers(3);
  markers[1].id = -1;
  CHECK(selected_tracks(encoder, markers) == std::vector<std::int64_t>{100, 102});
  CHECK(selected_tracks(encoder, {}).empty());
}

TEST_CASE("of two tracks with one id the more probable is sent, then the older") {
  PoseEncoder encoder("ROUNDEL");
  auto markers = sample_markers(4);
  markers[0].id = markers[1].id = markers[3].id = 5;
  markers[1].id_probability = 0.99;
  CHECK(selected_tracks(encoder, markers) == std::vector<std::int64_t>{101, 102});
  markers[1].id_probability = markers[0].id_probability;
  std::swap(markers[0], markers[3]);
  CHECK(selected_tracks(encoder, markers) == std::vector<std::int64_t>{102, 100});
  // Nothing is remembered from frame to frame.
  CHECK(selected_tracks(encoder, sample_markers(1)) == std::vector<std::int64_t>{100});
}

TEST_CASE("absurd ids are left out") {
  PoseEncoder encoder("ROUNDEL");
  auto markers = sample_markers(2);
  markers[0].id = 2147483647;
  markers[1].id = -2147483647;
  CHECK(selected_tracks(encoder, markers).empty());
}
