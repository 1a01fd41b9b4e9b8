#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "calibration/camera_file.hpp"
#include "daemon/image_file.hpp"
#include "tests/tools/run_roundel.hpp"

namespace roundel {
namespace {

const std::string kViews = "simulate --board --width 640 --height 360 --noise 2 ";

// Fifteen pictures of a board, and the truth about the camera; rendered once for all tests.
struct Pictures {
  Pictures() {
    REQUIRE(run_roundel(kViews + "--camera-out " + directory.file("true.yaml") + " -o " +
                        directory.file("views"))
                .status == 0);
  }
  std::string all() const { return directory.file("views") + "/*.png "; }
  std::string one(int i) const {
    return directory.file("views/frame_0000" + std::string(i < 10 ? "0" : "") + std::to_string(i) +
                          ".png ");
  }
  TemporaryDirectory directory;
};

const Pictures& pictures() {
  static const Pictures instance;
  return instance;
}

}  // namespace

TEST_CASE("pictures of a board become a camera file that other commands and ROS read") {
  const TemporaryDirectory directory;
  const CommandResult result = run_roundel("calibrate camera " + pictures().all() +
                                           "--name ceiling -o " + directory.file("camera.yaml"));
  CAPTURE(result.err);
  REQUIRE(result.status == 0);
  CHECK(contains(result.out, "640 x 360 pixels, 15 views of 7 x 4 markers"));
  CHECK(contains(result.out, "total error 0.0"));
  CHECK(contains(result.out, "saved as " + directory.file("camera.yaml")));

  const CameraFile found = read_camera_file(directory.file("camera.yaml"));
  const CameraModel truth = read_camera_file(pictures().directory.file("true.yaml")).camera;
  CHECK(found.name == "ceiling");
  CHECK(found.camera.width == 640);
  CHECK(std::abs(found.camera.fx / truth.fx - 1) < 0.001);
  CHECK(std::abs(found.camera.fy / truth.fy - 1) < 0.001);
  CHECK(std::abs(found.camera.cx - truth.cx) < 1);
  CHECK(std::abs(found.camera.cy - truth.cy) < 1);

  const std::string text = read_file(directory.file("camera.yaml"));
  CHECK(text.starts_with("# Made by roundel calibrate camera on 20"));
  CHECK(contains(text, "#   fx 4"));
  CHECK(contains(text, " ± 0.0"));
  const CommandResult detected = run_roundel(
      "detect --json --camera " + directory.file("camera.yaml") + " " + pictures().one(0));
  CHECK(detected.status == 0);
  CHECK(contains(detected.out, "\"position\""));
}

TEST_CASE("the JSON of a calibration carries parameters, deviations and views") {
  const CommandResult result = run_roundel("calibrate camera --json " + pictures().all());
  REQUIRE(result.status == 0);
  const auto lines = json_lines(result.out);
  REQUIRE(lines.size() == 1);
  const auto& json = lines[0];
  CHECK(json["width"] == 640);
  CHECK(json["height"] == 360);
  for (const char* name : {"fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3"}) {
    CAPTURE(name);
    CHECK(json["parameters"][name].is_number());
    CHECK(json["sigma"][name] > 0);
  }
  CHECK(json["error_px"] < 0.05);
  CHECK(json["worst_sigma_px"] > json["error_px"]);
  CHECK(json["print"]["off_m"] < 1e-5);
  CHECK(json["views"].size() == 15);
  CHECK(json["views"][3]["source"] == pictures().one(3).substr(0, pictures().one(3).size() - 1));
  CHECK(json["views"][3]["orientation"].size() == 4);
  CHECK(json["skipped"].empty());
  CHECK(json["advice"].is_array());
}

TEST_CASE("a video gives its good frames, and a pipe will do") {
  const CommandResult result = run_command(ROUNDEL_BINARY " " + kViews +
                                           "--frames 20 -o - | " ROUNDEL_BINARY
                                           " calibrate camera --json --exact-board --no-k3 -");
  CAPTURE(result.err);
  REQUIRE(result.status == 0);
  const auto json = json_lines(result.out)[0];
  CHECK(json["views"].size() >= 10);
  CHECK(contains(json["views"][0]["source"], "- frame "));
  CHECK(json["parameters"]["k3"] == 0);
  CHECK(json["sigma"]["k3"] == 0);
}

TEST_CASE("a picture without the board is named, the others calibrate") {
  const TemporaryDirectory directory;
  GreyImage empty;
  empty.resize(640, 360);
  save_png(directory.file("empty.png"), empty.view());
  const CommandResult result =
      run_roundel("calibrate camera " + pictures().all() + directory.file("empty.png"));
  CAPTURE(result.err);
  REQUIRE(result.status == 0);
  CHECK(contains(result.out, "not used: " + directory.file("empty.png") +
                                 ": the board is not in it, or too little of it"));
  CHECK(contains(result.out, "not saved: give -o FILE.yaml"));
}

TEST_CASE("what can't be calibrated is refused in one line that says what to do") {
  const TemporaryDirectory directory;
  GreyImage picture;
  picture.resize(320, 200);
  save_png(directory.file("small.png"), picture.view());
  const std::string calibrate = "calibrate camera ";
  check_refused("calibrate", 2, "subcommand");
  check_refused("calibrate camera --socket " + directory.file("none.sock"), 1,
                "roundeld can't be reached at");
  check_refused(calibrate + "none.png", 1, "none.png");
  check_refused(calibrate + pictures().one(0) + directory.file("small.png"), 1,
                "small.png is 320x200, but the pictures before it are 640x360; a calibration holds "
                "for one resolution");
  check_refused(calibrate + directory.file("small.png"), 1, "no marker was found in the picture");
  check_refused(calibrate + pictures().one(0) + pictures().one(1) + directory.file("none.png"), 1,
                "none.png");
  check_refused(calibrate + pictures().one(0) + pictures().one(1), 1,
                "only 2 of 2 pictures show at least 6 markers");
  check_refused(calibrate + "--columns 4 --rows 7 " + pictures().all(), 1,
                "--columns and --rows must be as printed");
  check_refused(calibrate + "--columns 8 " + pictures().all(), 2, "use more --bits");
  check_refused(calibrate + "--bits 9 " + pictures().all(), 1, "");
  check_refused(calibrate + pictures().all() + "-o /nowhere/camera.yaml", 1,
                "/nowhere/camera.yaml");
}

TEST_CASE("simulated views of a board come with their truth") {
  const TemporaryDirectory directory;
  REQUIRE(run_roundel(kViews + "--frames 3 --seed 4 --truth " + directory.file("t") + " -o " +
                      directory.file("v"))
              .status == 0);
  const auto truth = json_lines(read_file(directory.file("t")));
  REQUIRE(truth.size() == 3);
  CHECK(truth[0]["markers"].size() == 28);
  CHECK(truth[2]["frame"] == 2);
  CHECK(truth[0]["markers"][0]["position"] != truth[1]["markers"][0]["position"]);
  // What is visible is found where it is.
  const auto frames =
      json_lines(run_roundel("detect --json " + directory.file("v/frame_000001.png")).out);
  int found = 0, visible = 0;
  for (const auto& marker : truth[1]["markers"]) {
    if (!marker["visible"].get<bool>()) continue;
    ++visible;
    for (const auto& seen : frames[0]["markers"]) {
      if (seen["id"] == marker["id"] &&
          std::hypot(seen["u"].get<double>() - marker["u"].get<double>(),
                     seen["v"].get<double>() - marker["v"].get<double>()) < 1) {
        ++found;
      }
    }
  }
  CHECK(visible >= 18);
  CHECK(found >= visible - 1);
  check_refused("simulate --board --frames 1000000 -o -", 2, "at most 10000 views");
  check_refused("simulate --board --bits 6 -o -", 2, "use more --bits");
}

}  // namespace roundel
