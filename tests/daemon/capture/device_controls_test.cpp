#include "daemon/capture/device_controls.hpp"

#include <doctest/doctest.h>
#include <linux/videodev2.h>

#include <algorithm>

#include "daemon/capture/camera_controls.hpp"
#include "tests/daemon/capture/fake_camera.hpp"
#include "tests/error_of.hpp"

using namespace roundel;

namespace {

FakeCamera webcam() {
  FakeCamera camera;
  camera.state().controls = {
      {V4L2_CID_BRIGHTNESS, "Brightness", V4L2_CTRL_TYPE_INTEGER, -64, 64, 0, 0, {}},
      {V4L2_CID_AUTO_WHITE_BALANCE,
       "White Balance, Automatic",
       V4L2_CTRL_TYPE_BOOLEAN,
       0,
       1,
       1,
       0,
       {}},
      {V4L2_CID_EXPOSURE_AUTO,
       "Auto Exposure",
       V4L2_CTRL_TYPE_MENU,
       0,
       3,
       3,
       0,
       {"", "Manual Mode", "", "Aperture Priority Mode"}},
      {V4L2_CID_EXPOSURE_ABSOLUTE,
       "Exposure Time, Absolute",
       V4L2_CTRL_TYPE_INTEGER,
       1,
       5000,
       157,
       V4L2_CID_EXPOSURE_AUTO,
       {}},
  };
  return camera;
}

}  // namespace

TEST_CASE("controls are listed with the names that v4l2-ctl has for them") {
  const FakeCamera camera = webcam();
  const std::vector<Control> controls = list_controls(*camera.open(""));
  REQUIRE(controls.size() == 4);
  CHECK(controls[1].name == "white_balance_automatic");
  CHECK(controls[1].automatic);
  CHECK(controls[2].name == "auto_exposure");
  CHECK(value_text(controls[2]) == "Aperture Priority Mode");
  CHECK(controls[2].menu.size() == 2);
  CHECK(controls[3].name == "exposure_time_absolute");
  CHECK(controls[3].inactive);
  CHECK(controls[3].value == 157);
}

TEST_CASE("automatics are switched before the values that they own") {
  const FakeCamera camera = webcam();
  const auto remarks = apply_controls(*camera.open(""), {{"brightness", "-3"},
                                                         {"exposure_time_absolute", "50"},
                                                         {"white_balance_automatic", "false"},
                                                         {"auto_exposure", "manual mode"}});
  CHECK(remarks.empty());
  const std::vector<std::uint32_t>& order = camera.state().control_order;
  REQUIRE(order.size() == 4);
  const auto place = [&](std::uint32_t id) {
    return std::find(order.begin(), order.end(), id) - order.begin();
  };
  CHECK(place(V4L2_CID_EXPOSURE_AUTO) < place(V4L2_CID_EXPOSURE_ABSOLUTE));
  CHECK(place(V4L2_CID_AUTO_WHITE_BALANCE) < place(V4L2_CID_BRIGHTNESS));
  CHECK(camera.state().controls[3].value == 50);
}

TEST_CASE("what a camera does not do is told, and the rest is done") {
  const FakeCamera camera = webcam();
  const auto remarks = apply_controls(*camera.open(""), {{"brightness", "5"},
                                                         {"contrast", "1"},
                                                         {"auto_exposure", "Magic"},
                                                         {"exposure_time_absolute", "50"}});
  REQUIRE(remarks.size() == 3);
  CHECK(remarks[0] ==
        "auto_exposure: \"Magic\" can't be set; accepted: Manual Mode (1), Aperture "
        "Priority Mode (3)");
  CHECK(remarks[1].starts_with("contrast: the camera has no such control; it has: brightness, "));
  CHECK(remarks[2].starts_with("exposure_time_absolute: can't be set"));
  CHECK(camera.state().controls[0].value == 5);
}

TEST_CASE("values out of range, and texts that are no values, are refused") {
  const FakeCamera camera = webcam();
  const std::vector<Control> controls = list_controls(*camera.open(""));
  for (const char* text : {"65", "-65", "", "1.5", "0x10", "99999999999999999999", "true"}) {
    CAPTURE(text);
    CHECK_THROWS_AS(parse_control_value(controls[0], text), std::invalid_argument);
  }
  CHECK(parse_control_value(controls[1], "true") == 1);
  CHECK(parse_control_value(controls[1], "0") == 0);
  CHECK_THROWS_AS(parse_control_value(controls[1], "2"), std::invalid_argument);
  CHECK(parse_control_value(controls[2], "1") == 1);
  CHECK_THROWS_AS(parse_control_value(controls[2], "2"), std::invalid_argument);
}

TEST_CASE("a control that is set in a running camera is kept for its return") {
  const FakeCamera camera = webcam();
  CameraControls controls(camera, {{"brightness", "1"}});
  CHECK_THROWS_AS(controls.list(), CameraError);
  controls.attach("/dev/video0");
  CHECK(controls.list().size() == 4);
  CHECK(controls.set("brightness", "7").value == 7);
  CHECK(controls.wanted().at("brightness") == "7");
  CHECK_THROWS_AS(controls.set("brightness", "700"), std::invalid_argument);
  CHECK_THROWS_AS(controls.set("hue", "1"), std::invalid_argument);
  CHECK_THROWS_AS(controls.set("exposure_time_absolute", "5"), CameraError);
  CHECK(controls.wanted().size() == 1);
  CHECK(controls.replace({{"auto_exposure", "1"}, {"exposure_time_absolute", "9"}}).empty());
  CHECK(camera.state().controls[3].value == 9);
  CHECK(controls.wanted().size() == 2);
}
