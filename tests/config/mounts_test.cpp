#include "config/mounts.hpp"

#include <doctest/doctest.h>

#include "config/reader.hpp"
#include "tests/error_of.hpp"

using namespace roundel;

TEST_CASE("a mount is an id and what differs from the usual") {
  MountSettings settings;
  settings.height = 0.05;
  settings.rotation = 0.5;
  settings.mounts = {"7 height=0.12", "8 offset_x=-0.01 offset_y=0.02 rotation=1.57", "9"};
  const MarkerMounts mounts = marker_mounts(settings);
  REQUIRE(mounts.by_id.size() == 3);
  CHECK(mounts.by_id[0].id == 7);
  CHECK(mounts.by_id[0].mount.height_m == 0.12);
  CHECK(mounts.by_id[0].mount.rotation == 0.5);
  CHECK(mounts.by_id[1].mount.height_m == 0.05);
  CHECK(mounts.by_id[1].mount.offset_x_m == -0.01);
  CHECK(mounts.by_id[1].mount.offset_y_m == 0.02);
  CHECK(mounts.by_id[1].mount.rotation == 1.57);
  CHECK(mounts.by_id[2].mount.height_m == 0.05);
}

TEST_CASE("what is no mount is refused where it stands") {
  for (const char* text :
       {"", "height=1", "0 height=1", "70000", "7 height", "7 height=", "7 height=x", "7 height=-1",
        "7 height=nan", "7 depth=1", "7 height=1,"}) {
    CAPTURE(text);
    CHECK_FALSE(parse_mount(text, {}).has_value());
  }
  const std::string error =
      error_of([] { parse_configuration("marker:\n  mounts: [7 height=far]\n", "a.yaml", {}); });
  CHECK(error.find("a.yaml:2:11: marker.mounts") != std::string::npos);
  CHECK(error.find("as in [7 height=0.12]") != std::string::npos);
}

TEST_CASE("arena.mode is 2d or 3d") {
  CHECK(parse_configuration("arena: {mode: 3d}", "a", {}).values.arena.mode == "3d");
  CHECK(error_of([] { parse_configuration("arena: {mode: 4d}", "a", {}); }).find("2d, 3d") !=
        std::string::npos);
}
