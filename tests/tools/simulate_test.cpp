#include <doctest/doctest.h>

#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "calibration/camera_file.hpp"
#include "daemon/image_file.hpp"
#include "daemon/y4m.hpp"
#include "tests/tools/run_roundel.hpp"

namespace roundel {
namespace {

// Small enough to be fast, large enough to show the markers.
const std::string kSmall = "simulate --width 640 --height 360 --robots 3 --diameter 0.2 ";

}  // namespace

TEST_CASE("simulate writes video, camera and truth that belong together") {
  const TemporaryDirectory directory;
  const CommandResult result = run_roundel(
      kSmall + "--frames 5 --rate 12.5 --coded-corners --camera-out " + directory.file("c.yaml") +
      " --truth " + directory.file("t.jsonl") + " -o " + directory.file("v.y4m"));
  CAPTURE(result.err);
  REQUIRE(result.status == 0);
  CHECK(result.out == "");

  Y4mReader video(directory.file("v.y4m"));
  CHECK(video.format().width == 640);
  CHECK(video.format().height == 360);
  CHECK(video.format().frames_per_second() == 12.5);
  GreyImage frame;
  while (video.next(frame)) {
  }
  CHECK(video.frames_read() == 5);

  const CameraModel camera = read_camera_file(directory.file("c.yaml")).camera;
  CHECK(camera.width == 640);

  const auto truth = json_lines(read_file(directory.file("t.jsonl")));
  REQUIRE(truth.size() == 5);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    CHECK(truth[i]["frame"] == i);
    CHECK(truth[i]["utime"] == 80000 * i);
    REQUIRE(truth[i]["markers"].size() == 7);
    for (const auto& marker : truth[i]["markers"]) {
      CHECK(marker["kind"] == "whycode");
      CHECK(marker["id"] >= 1);
      CHECK(marker["id"] <= 7);
      CHECK(marker["visible"].is_boolean());
      const auto p = marker["position"].get<std::array<double, 3>>();
      const auto pixel = camera.project(Eigen::Vector3d(p[0], p[1], p[2]));
      REQUIRE(pixel);
      CHECK(marker["u"] == doctest::Approx(pixel->x()));
      CHECK(marker["v"] == doctest::Approx(pixel->y()));
      CHECK(marker["orientation"].size() == 4);
      for (const char* key : {"x", "y", "z", "heading"}) {
        CHECK(marker["arena"][key].is_number());
      }
    }
  }
}

TEST_CASE("standard output, a file and PNG pictures hold the same frames") {
  const TemporaryDirectory directory;
  const std::string options = kSmall + "--frames 3 --seed 9 -o ";
  REQUIRE(run_roundel(options + directory.file("v.y4m")).status == 0);
  REQUIRE(run_roundel(options + directory.file("png")).status == 0);
  const bool same = run_roundel(options + "-").out == read_file(directory.file("v.y4m"));
  CHECK(same);
  Y4mReader video(directory.file("v.y4m"));
  GreyImage frame;
  for (int i = 0; video.next(frame); ++i) {
    const GreyImage picture =
        load_image(directory.file("png/frame_00000" + std::to_string(i) + ".png"));
    CHECK(picture.pixels == frame.pixels);
  }
  CHECK_FALSE(std::filesystem::exists(directory.file("png/frame_000003.png")));
}

TEST_CASE("another seed, noise, blur, light or response is another picture") {
  const auto video = [](const std::string& options) {
    return run_roundel(kSmall + "--frames 4 -o - " + options).out;
  };
  const std::string usual = video("");
  const bool repeats = video("--seed 1") == usual;
  CHECK(repeats);
  for (const std::string& options : std::vector<std::string>{
           "--seed 2", "--noise 4", "--blur 1", "--gamma 2.2", "--srgb", "--gradient 0.3",
           "--shadow 0.5", "--no-clutter", "--no-corners", "--bits 7", "--ids 4,5,6", "--black 20",
           "--camera-height 4", "--tilt 10", "--turn 10", "--exposure 0.1", "--occluder"}) {
    CAPTURE(options);
    const std::string other = video(options);
    CHECK(other.size() == usual.size());
    const bool differs = other != usual;
    CHECK(differs);
  }
}

TEST_CASE("the ids given are those that the robots wear") {
  const TemporaryDirectory directory;
  REQUIRE(run_roundel(kSmall + "--ids 9,30,9 --frames 1 --no-corners --truth " +
                      directory.file("t") + " -o " + directory.file("d"))
              .status == 0);
  const auto truth = json_lines(read_file(directory.file("t")));
  REQUIRE(truth.size() == 1);
  const auto& markers = truth[0]["markers"];
  REQUIRE(markers.size() == 3);
  CHECK(markers[0]["id"] == 9);
  CHECK(markers[1]["id"] == 30);
  CHECK(markers[2]["id"] == 9);
}

TEST_CASE("an arena that can't be is refused") {
  check_refused("simulate", 2, "--output is required");
  check_refused("simulate --frames 0 -o -", 2, "--frames");
  check_refused("simulate --noise 61 -o -", 2, "--noise");
  check_refused("simulate --bits 1 -o -", 2, "a code of 1 bits does not exist");
  check_refused("simulate --robots 31 -o -", 2, "9 bits would do");
  check_refused("simulate --ids 31 -o -", 2, "this set has the ids 1 to 30");
  check_refused("simulate --robots 1000 --bits 16 -o -", 2, "robots");
  check_refused("simulate -o frames.mp4", 2, "use FILE.y4m, - or a directory");
  check_refused("simulate --camera none.yaml -o -", 1, "none.yaml");
  check_refused("simulate --camera none.yaml --width 640 -o -", 2, "excludes");
  check_refused("simulate --truth /nowhere/t -o -", 1, "/nowhere/t can't be written");
  check_refused("simulate --camera-out /nowhere/c -o -", 1, "/nowhere/c");
  check_refused("simulate -o /proc/frames", 1, "/proc/frames can't be created");
  check_refused("simulate --frames 2 -o - >/dev/full", 1, "standard output can't be written");
}

}  // namespace roundel
