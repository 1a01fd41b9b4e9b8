#include "tools/pose_csv.hpp"

#include <doctest/doctest.h>

#include <algorithm>

#include "daemon/json_frame.hpp"
#include "tests/error_of.hpp"
#include "tests/sample_markers.hpp"
#include "tests/tools/run_roundel.hpp"

using namespace roundel;

namespace {

std::size_t columns(const std::string& line) {
  return 1 + static_cast<std::size_t>(std::count(line.begin(), line.end(), ','));
}

}  // namespace

TEST_CASE("every row has as many fields as the heading") {
  const std::string heading = pose_csv_heading();
  CHECK(heading.starts_with("frame,utime_us,session,id,id_probability,track,u_px,v_px,"));
  CHECK(heading.ends_with("arena_sigma_heading_rad\n"));
  const FrameInfo info{"north", 3, 1000, 20};
  const std::string rows = pose_csv_rows(frame_json(info, sample_markers(2)));
  const std::size_t end = rows.find('\n');
  CHECK(columns(rows.substr(0, end)) == columns(heading));
  CHECK(columns(rows.substr(end + 1)) == columns(heading));
  CHECK(rows.starts_with("3,1000,,1,0.95,100,10.25,20.5,19.75,19.5,0.25,0.125,-0.25,3.0,0.5,"));
}

TEST_CASE("a frame without markers is a row, a marker without a pose has empty fields") {
  const FrameInfo info{"north", 4, 2000, 20};
  const std::string none = pose_csv_rows(frame_json(info, {}));
  CHECK(none == "4,2000," + std::string(columns(pose_csv_heading()) - 3, ',') + "\n");
  Marker marker = sample_marker(0);
  marker.has_pose = false;
  CHECK(pose_csv_rows(frame_json(info, {&marker, 1})) ==
        "4,2000,,1,0.95,100,10.25,20.5,19.75,19.5,0.25" + std::string(22, ',') + "\n");
}

TEST_CASE("what is no frame is refused with its place") {
  CHECK(error_of([] { pose_csv_rows({{"frame", 1}}); }) == "markers is missing");
  CHECK(error_of([] {
          pose_csv_rows({{"frame", 1}, {"markers", {{{"id", 1}, {"u", "far"}}}}});
        }) == "u_px is not a number");
  check_refused("export /nonexistent", 1, "/nonexistent can't be opened");
  const TemporaryDirectory folder;
  check_refused("export " + folder.write("a.jsonl", "{}\n"), 1, "a.jsonl:1: frame is missing");
}
