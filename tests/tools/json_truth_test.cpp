#include "tools/json_truth.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <string>

#include "daemon/json_frame.hpp"
#include "tests/error_of.hpp"

namespace roundel {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

FrameTruth whole_truth() {
  FrameTruth truth;
  truth.frame = 41;
  truth.time_s = 1.366667;
  MarkerTruth robot;
  robot.id = 7;
  robot.pose = {{0.1, -0.2, 3}, Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5)};
  robot.u = 123.456;
  robot.v = 0.1;
  robot.visible = true;
  MarkerTruth behind;
  behind.kind = MarkerKind::WhyCon;
  behind.pose.position = {0, 0, -1};
  behind.u = behind.v = kNan;
  MarkerTruth disc;
  disc.kind = MarkerKind::Disc;
  truth.markers = {robot, behind, disc};
  return truth;
}

// The error with one marker's field replaced (or removed, by a discarded value).
std::string refusal(const char* key, const Json& value) {
  Json json = truth_json(whole_truth());
  if (value.is_discarded()) {
    json["markers"][0].erase(key);
  } else {
    json["markers"][0][key] = value;
  }
  return error_of([&] { truth_from_json(json); });
}

}  // namespace

TEST_CASE("the truth reads back as it was written") {
  const FrameTruth written = whole_truth();
  const FrameTruth read = truth_from_json(Json::parse(json_line(truth_json(written))));
  CHECK(read.frame == 41);
  CHECK(read.time_s == doctest::Approx(1.366667));
  REQUIRE(read.markers.size() == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    CAPTURE(i);
    CHECK(read.markers[i].kind == written.markers[i].kind);
    CHECK(read.markers[i].id == written.markers[i].id);
    CHECK(read.markers[i].visible == written.markers[i].visible);
    CHECK(read.markers[i].pose.position == written.markers[i].pose.position);
    CHECK(read.markers[i].pose.orientation.coeffs() ==
          written.markers[i].pose.orientation.coeffs());
  }
  CHECK(read.markers[0].u == 123.456);
  CHECK(read.markers[0].v == 0.1);
  CHECK(std::isnan(read.markers[1].u));  // behind the camera: no image
  CHECK(std::isnan(read.markers[1].v));
}

TEST_CASE("a truth with a field missing or wrong is refused by its name") {
  const Json missing(Json::value_t::discarded);
  CHECK(refusal("id", missing) == "markers[0]: id is missing");
  CHECK(refusal("id", 0) == "markers[0]: id is 0, not between 1 and 2147483647");
  CHECK(refusal("kind", "tag") == "markers[0]: kind is not whycode, whycon or disc");
  CHECK(refusal("kind", 1) == "markers[0]: kind is not a text");
  CHECK(refusal("visible", 1) == "markers[0]: visible is not true or false");
  CHECK(refusal("u", nullptr) == "markers[0]: is visible but has no image (u, v)");
  CHECK(refusal("v", "3") == "markers[0]: v is not a number");
  CHECK(refusal("position", {1, 2}) == "markers[0]: position is not a list of 3 numbers");
  CHECK(refusal("orientation", {0.5, 0.5, 0.5, 0.6}) ==
        "markers[0]: orientation is not a unit quaternion");
  CHECK(error_of([] { truth_from_json(Json::parse("[]")); }) ==
        "no object where one with \"frame\" should be");
  CHECK(error_of([] { truth_from_json(Json::parse(R"({"frame":0,"utime":0,"markers":{}})")); }) ==
        "markers is not a list");
}

}  // namespace roundel
