#include "tools/pose_table.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

#include "tests/sample_markers.hpp"

using namespace roundel;

namespace {

constexpr std::size_t kAll = 1000;

ReceivedFrame frame_of(const std::vector<Marker>& markers) {
  ReceivedFrame frame;
  frame.header = to_message(sample_information(42));
  frame.camera = "east";
  for (const Marker& marker : markers) frame.markers.push_back(to_message(marker));
  return frame;
}

ReceptionCounts counts_of(std::int64_t frames) {
  return {frames, 3, 0};
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("the table says so before anything has arrived") {
  CHECK(PoseTable().text(kAll, 5) == "no frame has arrived yet\n");
}

TEST_CASE("the heading tells camera, frame, rate, latency and losses") {
  PoseTable table;
  const ReceivedFrame frame = frame_of({});
  for (std::int64_t i = 0; i <= 30; ++i) {
    table.add(frame, counts_of(i + 1), frame.header.capture_utime + 12'345, 1000 + 33'333 * i);
  }
  const std::string text = table.text(kAll, 1'001'000);
  CHECK(has(text,
            "east (simulated), 1920x1080, calibrated; frame 42, 31.0 frames/s, latency 12.3 "
            "ms"));
  CHECK(has(text, "lost 3\n"));
}

TEST_CASE("rows come by id, unknown ones last, with yaw where there is a code") {
  PoseTable table;
  auto markers = sample_markers(3);
  std::swap(markers[0], markers[2]);
  markers[1].id = -1;
  markers[0].pose.orientation = {1, 0, 0, 0};
  table.add(frame_of(markers), counts_of(1), 0, 1000);
  const std::string text = table.text(kAll, 2000);
  const std::size_t first = text.find("    1    100"), second = text.find("    3    102"),
                    last = text.find("    ?    101");
  REQUIRE(first != std::string::npos);
  REQUIRE(second != std::string::npos);
  REQUIRE(last != std::string::npos);
  CHECK(first < second);
  CHECK(second < last);
  CHECK(has(text.substr(second, last - second), "2.125   -0.250    3.000     0.0     4.48"));
  CHECK(has(text.substr(last), "3.000       -"));
}

TEST_CASE("a marker without a pose says so") {
  PoseTable table;
  auto markers = sample_markers(1);
  markers[0].has_pose = false;
  table.add(frame_of(markers), counts_of(1), 0, 1000);
  CHECK(has(table.text(kAll, 2000), "no pose"));
}

TEST_CASE("a track that is not seen for a second disappears") {
  PoseTable table;
  table.add(frame_of(sample_markers(1)), counts_of(1), 0, 1000);
  CHECK(has(table.text(kAll, 900'000), "    1    100"));
  table.add(frame_of({}), counts_of(2), 0, 1'500'000);
  CHECK_FALSE(has(table.text(kAll, 1'500'000), "    1    100"));
}

TEST_CASE("rows that do not fit are counted") {
  PoseTable table;
  table.add(frame_of(sample_markers(20)), counts_of(1), 0, 1000);
  const std::string text = table.text(5, 2000);
  CHECK(has(text, "... and 15 more\n"));
  CHECK(std::count(text.begin(), text.end(), '\n') == 2 + 5 + 1);
}
