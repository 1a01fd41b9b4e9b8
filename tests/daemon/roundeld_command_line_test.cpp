// What roundeld says and returns for right and wrong input, in a process of its own.
#include <doctest/doctest.h>

#include <algorithm>

#include "config/default_yaml.hpp"
#include "tests/child_process.hpp"
#include "tests/temporary_directory.hpp"

using namespace roundel;

namespace {

Finished roundeld(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), ROUNDELD_BINARY);
  return run_program(arguments);
}

bool is_one_line(const std::string& text) {
  return !text.empty() && text.back() == '\n' && std::count(text.begin(), text.end(), '\n') == 1;
}

void check_refused(const Finished& finished, int status, const std::string& message) {
  CAPTURE(finished.errors);
  CHECK(finished.status == status);
  CHECK(is_one_line(finished.errors));
  CHECK(finished.errors.find(message) != std::string::npos);
  CHECK(finished.output.empty());
}

const std::string kSmallCamera =
    "image_width: 640\nimage_height: 480\n"
    "camera_matrix: {rows: 3, cols: 3, data: [500, 0, 320, 0, 500, 240, 0, 0, 1]}\n"
    "distortion_model: plumb_bob\n"
    "distortion_coefficients: {rows: 1, cols: 5, data: [0, 0, 0, 0, 0]}\n";

}  // namespace

TEST_CASE("--print-config prints the commented default, which is right as it is") {
  const Finished printed = roundeld({"--print-config"});
  CHECK(printed.status == 0);
  CHECK(printed.output == default_yaml());
  const TemporaryDirectory folder;
  const std::string path = folder.write("roundel.yaml", printed.output);
  const Finished checked = roundeld({"--check-config", "--config", path});
  CHECK(checked.status == 0);
  CHECK(checked.output == path + ": the configuration is right\n");
}

TEST_CASE("a camera is checked as far as that goes without it") {
  CHECK(roundeld({"--check-config", "--set", "source=camera"}).status == 0);
  check_refused(
      roundeld({"--set", "source=camera", "--set", "camera.format=RGB3"}), 2,
      "camera.format: \"RGB3\" is no format that can be read; accepted: auto, GREY, NV12");
}

TEST_CASE("--help and --version end with 0") {
  CHECK(roundeld({"--help"}).output.find("--check-config") != std::string::npos);
  CHECK(roundeld({"--version"}).output.starts_with("roundeld "));
  CHECK(roundeld({"--version"}).status == 0);
}

TEST_CASE("a wrong configuration ends with 2 and one line with file, line and column") {
  const TemporaryDirectory folder;
  const std::string path = folder.write("roundel.yaml", "simulator:\n  robot: 3\n");
  for (const bool only_check : {true, false}) {
    std::vector<std::string> arguments = {"--config", path};
    if (only_check) arguments.emplace_back("--check-config");
    check_refused(roundeld(arguments), 2,
                  path + ":2:3: simulator.robot: unknown key (did you mean simulator.robots?)");
  }
  check_refused(roundeld({"--config", folder.file("none.yaml")}), 2, "can't be opened");
}

TEST_CASE("wrong usage ends with 2 and one line") {
  check_refused(roundeld({"--nonsense"}), 2, "--nonsense");
  check_refused(roundeld({"file.yaml"}), 2, "file.yaml");
  check_refused(roundeld({"--set", "simulator.robots=many"}), 2,
                "--set simulator.robots=many: simulator.robots: \"many\" is not a whole number");
  check_refused(roundeld({"--check-config", "--print-config"}), 2, "--check-config");
}

TEST_CASE("an unusable LCM URL is refused with its place before anything starts") {
  const TemporaryDirectory folder;
  const std::string path = folder.write("roundel.yaml", "lcm:\n  url: udpm://300.0.0.1:7667\n");
  for (const char* mode : {"--check-config", "--set=camera.name=a"}) {
    check_refused(roundeld({"--config", path, mode}), 2,
                  path +
                      ":2:8: lcm.url: \"udpm://300.0.0.1:7667\" is no usable LCM URL: "
                      "\"300.0.0.1\" is not an IPv4 address");
  }
}

TEST_CASE("robots that do not fit into the arena are refused") {
  check_refused(roundeld({"--check-config", "--set", "simulator.robots=400"}), 2, "simulator: ");
}

TEST_CASE("a camera file of another resolution ends with 1 and one line that names both") {
  const TemporaryDirectory folder;
  const std::string camera = folder.write("camera.yaml", kSmallCamera);
  check_refused(roundeld({"--check-config", "--set", "camera.calibration=" + camera}), 1,
                camera + ": calibrated at 640x480, but the frames are 1920x1080");
  const std::string image = folder.write("a.pgm", "P5 2 2 255\n1234");
  check_refused(roundeld({"--set", "source=files", "--set", "files.paths=[" + image + "]", "--set",
                          "camera.calibration=" + camera, "--set", "lcm.url=memq://"}),
                1, camera + ": calibrated at 640x480, but the frames are 2x2");
  const std::string bad = folder.write("bad.yaml", "image_width: 640\n");
  check_refused(roundeld({"--check-config", "--set", "camera.calibration=" + bad}), 1,
                bad + ": image_height: is missing");
}

TEST_CASE("a recording that can't be opened ends with 1 and one line") {
  const TemporaryDirectory folder;
  const std::string none = folder.file("none.png");
  check_refused(roundeld({"--set", "source=files", "--set", "files.paths=[" + none + "]", "--set",
                          "lcm.url=memq://"}),
                1, none + ": no such file");
}

TEST_CASE(
    "a recording is played to its end, and the status tells whether all of it could be read") {
  const TemporaryDirectory folder;
  const std::string good = folder.write("a.pgm", "P5 20 20 255\n" + std::string(400, 'x'));
  const std::string bad = folder.write("b.pgm", "P5 20 20 255\nx");
  const auto play = [&](const std::string& paths) {
    return roundeld({"--set", "source=files", "--set", "files.paths=" + paths, "--set",
                     "files.frame_rate=0", "--set", "lcm.url=memq://"});
  };
  CHECK(play("[" + good + "]").status == 0);
  const Finished damaged = play("[" + good + ", " + bad + ", " + good + "]");
  CHECK(damaged.status == 1);
  CHECK(damaged.errors.find("error: " + bad) != std::string::npos);
}
