#include "tools/reception_summary.hpp"

#include <doctest/doctest.h>

using namespace roundel;

namespace {

ReceivedFrame frame_at(std::int64_t capture_utime) {
  ReceivedFrame frame;
  frame.header.capture_utime = capture_utime;
  frame.markers.resize(3);
  return frame;
}

}  // namespace

TEST_CASE("rate, losses and latency of what arrived are told") {
  ReceptionSummary summary;
  for (int i = 0; i < 101; ++i) {  // 50 frames a second, each 8 ms after its capture, one 90 ms
    const std::int64_t utime = 1'700'000'000'000'000 + 20'000 * i;
    summary.add(frame_at(utime), utime + (i == 50 ? 90'000 : 8'000), 20'000 * i);
  }
  const ReceptionCounts counts{101, 3, 7};
  const nlohmann::ordered_json json = summary.json(counts);
  CHECK(json["frames"] == 101);
  CHECK(json["markers"] == 303);
  CHECK(json["lost"] == 3);
  CHECK(json["garbage"] == 7);
  CHECK(json["rate"] == 50.0);
  CHECK(json["latency_us"]["p50"].get<double>() == doctest::Approx(8000).epsilon(0.03));
  CHECK(json["latency_us"]["max"] == 90'000);
  CHECK(json["interval_us"]["p99"].get<double>() == doctest::Approx(20'000).epsilon(0.03));
  const std::string text = summary.text(counts);
  CHECK(text.starts_with("101 frames, 50.0 a second, 3.0 markers in each; 3 lost (2.88 %), 7 "));
  CHECK(text.find("worst 90.00 ms") != std::string::npos);
}

TEST_CASE("nothing that arrived is told as nothing") {
  CHECK(ReceptionSummary().text({}) == "no frame arrived\n");
  CHECK(ReceptionSummary().json({})["rate"] == 0.0);
}
