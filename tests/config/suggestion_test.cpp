#include "config/suggestion.hpp"

#include <doctest/doctest.h>

using namespace roundel;

TEST_CASE("a misspelled key is told the key that was meant") {
  CHECK(nearest_key("simulator.robot") == "simulator.robots");
  CHECK(nearest_key("simulator.framerate") == "simulator.frame_rate");
  CHECK(nearest_key("lcm.chanel") == "lcm.channel");
  CHECK(nearest_key("sorce") == "source");
}

TEST_CASE("a key in the wrong section is told its right place") {
  CHECK(nearest_key("diameter") == "marker.diameter");
  CHECK(nearest_key("detector.bits") == "marker.bits");
  CHECK(nearest_key("camera.url") == "lcm.url");
}

TEST_CASE("a key that is like no other gets no suggestion") {
  CHECK(nearest_key("xyzzy").empty());
  CHECK(nearest_key("simulator.quantum_flux").empty());
  CHECK(nearest_key(std::string(100000, 'x')).empty());
}

TEST_CASE("a section's keys are listed in the file's order") {
  CHECK(keys_of_section("") ==
        "source, simulator, files, camera, marker, arena, detector, lcm, control");
  CHECK(keys_of_section("marker") ==
        "diameter, bits, hamming, inner_ratio, height, offset_x, offset_y, rotation, mounts");
}
