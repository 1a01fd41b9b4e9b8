#include "daemon/json_frame.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <string>

#include "tests/error_of.hpp"

namespace roundel {
namespace {

Marker whole_marker() {
  Marker marker;
  marker.id = 7;
  marker.id_probability = 0.9998;
  marker.track = 3;
  marker.u = 812.31;
  marker.v = 440.07;
  marker.ellipse = {812.3, 440.1, 19.8, 19.1, 0.3};
  marker.has_pose = true;
  marker.pose.position = {0.11, -0.02, 3.01};
  marker.pose.orientation = Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5);
  marker.sigma_position = {0.001, 0.002, 0.003};
  marker.sigma_rotation = {0.01, 0.02, 0.03};
  marker.ambiguity = 0.02;
  marker.has_alternative = true;
  marker.alternative.position = {0.12, -0.03, 3.02};
  marker.alternative.orientation = Eigen::Quaterniond(1, 0, 0, 0);
  return marker;
}

}  // namespace

TEST_CASE("the JSON object of a frame keeps its field names, units and order") {
  const std::array markers = {whole_marker()};
  CHECK(json_line(frame_json({"frame_0001.png", 5, 166667, 31.4}, markers)) ==
        R"({"source":"frame_0001.png","frame":5,"utime":166667,"elapsed_us":31.4,"markers":[)"
        R"({"id":7,"id_probability":0.9998,"track":3,"u":812.31,"v":440.07,)"
        R"("ellipse":{"a":19.8,"b":19.1,"angle":0.3},)"
        R"("position":[0.11,-0.02,3.01],"orientation":[0.5,0.5,-0.5,0.5],)"
        R"("sigma":{"position":[0.001,0.002,0.003],"rotation":[0.01,0.02,0.03]},)"
        R"("ambiguity":0.02,)"
        R"("alternative":{"position":[0.12,-0.03,3.02],"orientation":[1.0,0.0,0.0,0.0]}}]})"
        "\n");
}

TEST_CASE("without a camera the pose is left out of the JSON and the pixels remain") {
  Marker marker = whole_marker();
  marker.has_pose = false;
  CHECK(marker_json(marker).dump() ==
        R"({"id":7,"id_probability":0.9998,"track":3,"u":812.31,"v":440.07,)"
        R"("ellipse":{"a":19.8,"b":19.1,"angle":0.3}})");
}

TEST_CASE("the other pose is left out of the JSON where there is none") {
  Marker marker = whole_marker();
  marker.has_alternative = false;
  CHECK_FALSE(marker_json(marker).contains("alternative"));
  CHECK(marker_json(marker).contains("ambiguity"));
}

TEST_CASE("a frame without markers is an object with an empty list") {
  CHECK(json_line(frame_json({"a.png", 0, 0, 2.5}, {})) ==
        R"({"source":"a.png","frame":0,"utime":0,"elapsed_us":2.5,"markers":[]})"
        "\n");
}

TEST_CASE("a file name that is no UTF-8 still makes JSON") {
  CHECK(nlohmann::json::accept(json_line(frame_json({"bad\xff.png", 0, 0, 1}, {}))));
}

TEST_CASE("a frame reads back as it was written, but for what is not needed") {
  Marker far = whole_marker();
  far.id = -1;
  far.track = 0;
  far.has_pose = false;
  const std::array markers = {whole_marker(), far};
  const ReportedFrame read = frame_from_json(
      nlohmann::ordered_json::parse(json_line(frame_json({"a", 5, 0, 1}, markers))));
  CHECK(read.frame == 5);
  REQUIRE(read.markers.size() == 2);
  const Marker& marker = read.markers[0];
  CHECK(marker.id == 7);
  CHECK(marker.id_probability == 0.9998);
  CHECK(marker.track == 3);
  CHECK(marker.u == 812.31);
  CHECK(marker.v == 440.07);
  CHECK(marker.has_pose);
  CHECK(marker.pose.position == whole_marker().pose.position);
  CHECK(marker.pose.orientation.coeffs() == whole_marker().pose.orientation.coeffs());
  CHECK(marker.sigma_position == whole_marker().sigma_position);
  CHECK(marker.sigma_rotation == whole_marker().sigma_rotation);
  CHECK(read.markers[1].id == -1);
  CHECK_FALSE(read.markers[1].has_pose);
}

TEST_CASE("what other programs write may have no track, no sigma and rounded numbers") {
  const ReportedFrame read = frame_from_json(nlohmann::ordered_json::parse(
      R"({"frame":0,"markers":[{"id":1,"u":2,"v":3,"position":[0,0,3],)"
      R"("orientation":[-0.7071,0.7071,0,0]}]})"));
  REQUIRE(read.markers.size() == 1);
  CHECK(read.markers[0].track == 0);
  CHECK(read.markers[0].sigma_position == Eigen::Vector3d::Zero());
  CHECK(read.markers[0].pose.orientation.w() == doctest::Approx(std::sqrt(0.5)).epsilon(1e-12));
}

TEST_CASE("a frame with a field missing or wrong is refused by its name") {
  const auto refusal = [](const std::string& text) {
    return error_of([&] { frame_from_json(nlohmann::ordered_json::parse(text)); });
  };
  const auto marker_refusal = [&](const std::string& fields) {
    return refusal(R"({"frame":0,"markers":[{"id":1,"u":2,"v":3},{)" + fields + "}]}");
  };
  CHECK(refusal("3") == "no object where one with \"frame\" should be");
  CHECK(refusal("{}") == "frame is missing");
  CHECK(refusal(R"({"frame":0.5})") == "frame is not a whole number");
  CHECK(refusal(R"({"frame":-1})") == "frame is -1, not between 0 and 9223372036854775807");
  CHECK(refusal(R"({"frame":9223372036854775808})") ==
        "frame is 9223372036854775808, not between 0 and 9223372036854775807");
  CHECK(refusal(R"({"frame":0})") == "markers is missing");
  CHECK(refusal(R"({"frame":0,"markers":3})") == "markers is not a list");
  CHECK(refusal(R"({"frame":0,"markers":[3]})") ==
        "markers[0]: no object where one with \"id\" should be");
  CHECK(marker_refusal(R"("u":1)") == "markers[1]: id is missing");
  CHECK(marker_refusal(R"("id":2147483648)") ==
        "markers[1]: id is 2147483648, not between -1 and 2147483647");
  CHECK(marker_refusal(R"("id":1,"u":null)") == "markers[1]: u is not a number");
  CHECK(marker_refusal(R"("id":1,"u":1,"v":1,"track":-1)") ==
        "markers[1]: track is -1, not between 0 and 9223372036854775807");
  CHECK(marker_refusal(R"("id":1,"u":1,"v":1,"position":[1,2,3])") ==
        "markers[1]: orientation is missing");
  CHECK(marker_refusal(R"("id":1,"u":1,"v":1,"position":[1,2,"3"],"orientation":[1,0,0,0])") ==
        "markers[1]: position is not a list of 3 numbers");
  CHECK(marker_refusal(R"("id":1,"u":1,"v":1,"position":[1,2,3],"orientation":[0,0,0,0])") ==
        "markers[1]: orientation is not a unit quaternion");
  CHECK(marker_refusal(R"("id":1,"u":1,"v":1,"sigma":{"position":[1,2,3]})") ==
        "markers[1]: rotation is missing");
}

}  // namespace roundel
