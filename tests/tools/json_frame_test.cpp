#include "tools/json_frame.hpp"

#include <doctest/doctest.h>

#include <array>
#include <string>

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

}  // namespace roundel
