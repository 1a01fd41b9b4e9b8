// What users and scripts see of the real program: exit statuses, messages, files.

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "daemon/image_file.hpp"
#include "tests/tools/run_roundel.hpp"

namespace roundel {
namespace {

constexpr const char* kCamera = R"(image_width: 640
image_height: 480
camera_name: test
camera_matrix: {rows: 3, cols: 3, data: [500, 0, 320, 0, 500, 240, 0, 0, 1]}
distortion_model: plumb_bob
distortion_coefficients: {rows: 1, cols: 5, data: [0, 0, 0, 0, 0]}
)";

std::string grey_png(const TemporaryDirectory& directory, const char* name, int width, int height) {
  GreyImage image;
  image.resize(width, height);
  std::fill(image.pixels.begin(), image.pixels.end(), std::uint8_t{128});
  save_png(directory.file(name), image.view());
  return directory.file(name);
}

std::string y4m(int width, int height, int frames) {
  std::string text =
      "YUV4MPEG2 W" + std::to_string(width) + " H" + std::to_string(height) + " F25:1 Cmono\n";
  for (int i = 0; i < frames; ++i) {
    text += "FRAME\n" + std::string(static_cast<std::size_t>(width * height), '\x80');
  }
  return text;
}

}  // namespace

TEST_CASE("help is printed for the program and every subcommand, with status 0") {
  for (const char* command : {"", "detect", "track", "markers", "simulate", "compare", "cameras"}) {
    const CommandResult result = run_roundel(std::string(command) + " --help");
    CAPTURE(command);
    CHECK(result.status == 0);
    CHECK(contains(result.out, "Usage: roundel"));
    CHECK(result.err == "");
  }
}

TEST_CASE("wrong usage ends with status 2 and one line") {
  check_refused("", 2, "name a subcommand: detect, track, ");
  check_refused("fly", 2, "there is no subcommand fly; use detect, track, ");
  check_refused("--fly", 2, "--fly");
  check_refused("detect", 2, "FILE is required");
  check_refused("detect --frobnicate a.png", 2, "--frobnicate");
  check_refused("detect --bits eight a.png", 2, "--bits");
  check_refused("detect --diameter -1 a.png", 2, "--diameter");
  check_refused("detect --max-markers 0 a.png", 2, "--max-markers");
  check_refused("detect --arena a.yaml a.png", 2, "--arena needs --camera");
  check_refused("markers --id 31 -o m.pdf", 2, "there is no id 31; this set has the ids 1 to 30");
  check_refused("markers --id 17 --hamming 2 -o m.pdf", 2, "the ids 1 to 16");
  check_refused("markers --id 1 --bits 17 -o m.pdf", 2, "a code of 17 bits does not exist");
  check_refused("markers --id 1 --hamming 5 -o m.pdf", 2, "use 1 to 4");
  check_refused("markers --id 1 --diameter 0.2 -o m.pdf", 2, "does not fit A4: at most 0.1526 m");
  check_refused("markers --id 1 --diameter 0 -o m.pdf", 2, "--diameter");
  check_refused("markers --plain 0.61 -o m.pdf", 2, "0.33 to 0.60");
  check_refused("markers --plain 0.32 -o m.pdf", 2, "0.33 to 0.60");
  check_refused("markers --plain 0 -o m.pdf", 2, "0.33 to 0.60");
  check_refused("markers --id 1 --plain 0.5 -o m.pdf", 2, "xactly 1 option");
  check_refused("markers --id 1 --paper A9 -o m.pdf", 2, "use A4, A3, Letter or none");
  check_refused("markers --id 1 -o m.gif", 2, "end it in .pdf, .svg or .png");
  check_refused("markers --id 1", 2, "--output is required");
  check_refused("markers --id 1 --dpi 2400 --paper A3 -o m.png", 2, "lower --dpi");
}

TEST_CASE("missing and damaged images end with status 1 and their name") {
  const TemporaryDirectory directory;
  const std::string png = grey_png(directory, "a.png", 640, 480);
  const std::string whole = read_file(png);
  check_refused("detect " + directory.file("none.png"), 1, "none.png can't be opened: No such");
  check_refused("detect " + directory.write("cut.png", whole.substr(0, whole.size() / 2)), 1,
                "cut.png is truncated or damaged");
  check_refused("detect " + directory.write("text.png", "hello"), 1, "text.png is not an image");
  check_refused("track " + directory.file("none.y4m"), 1, "none.y4m can't be opened");
  check_refused("track " + directory.write("a.y4m", "YUV4MPEG2 W5\n"), 1, "a.y4m has no width");
  check_refused("track - </dev/null", 1, "standard input is empty");
}

TEST_CASE("frames before a damaged one are reported all the same") {
  const TemporaryDirectory directory;
  const std::string video = y4m(64, 48, 3);
  const CommandResult result =
      run_roundel("track --json " + directory.write("a.y4m", video.substr(0, video.size() - 10)));
  CHECK(result.status == 1);
  CHECK(contains(result.err, "a.y4m, frame 2, is truncated"));
  CHECK(json_lines(result.out).size() == 2);
}

TEST_CASE("a camera file of another resolution is refused with both resolutions") {
  const TemporaryDirectory directory;
  const std::string camera = directory.write("camera.yaml", kCamera);
  const std::string fitting = grey_png(directory, "fit.png", 640, 480);
  const std::string other = grey_png(directory, "other.png", 320, 240);
  CHECK(run_roundel("detect --camera " + camera + " " + fitting).status == 0);
  check_refused("detect --camera " + camera + " " + other, 1, "320x240");
  check_refused("detect --camera " + camera + " " + other, 1, "640x480");
  check_refused("detect --camera " + camera + " " + other, 1, "other.png");
  check_refused("detect --camera " + directory.file("none.yaml") + " " + other, 1, "none.yaml");
  check_refused("detect --camera " + directory.write("bad.yaml", "a: [") + " " + other, 1,
                "bad.yaml");
}

TEST_CASE("frames of two sizes can be detected but not tracked") {
  const TemporaryDirectory directory;
  const std::string files =
      grey_png(directory, "a.png", 64, 48) + " " + grey_png(directory, "b.png", 48, 64);
  CHECK(run_roundel("detect " + files).status == 0);
  check_refused("track " + files, 1, "b.png is 48x64 and follows frames of 64x48");
}

TEST_CASE("every frame of images, video and standard input is one JSON line") {
  const TemporaryDirectory directory;
  const std::string image = grey_png(directory, "a.png", 64, 48);
  const std::string video = directory.write("v.y4m", y4m(64, 48, 3));
  const auto lines =
      json_lines(run_roundel("track --json " + image + " " + video + " - <" + video).out);
  REQUIRE(lines.size() == 7);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    CHECK(lines[i]["frame"] == i);
    CHECK(lines[i]["source"] == (i == 0 ? image : i < 4 ? video : "-"));
    CHECK(lines[i]["utime"] == (i == 0 ? 0 : (i - 1) % 3 * 40000));
    CHECK(lines[i]["elapsed_us"] >= 0);
    CHECK(lines[i]["markers"].is_array());
  }
}

TEST_CASE("annotated pictures go to a file for one frame and to a directory for several") {
  const TemporaryDirectory directory;
  const std::string image = grey_png(directory, "a.png", 64, 48);
  const std::string video = directory.write("v.y4m", y4m(64, 48, 2));
  CHECK(run_roundel("detect --annotate " + directory.file("x.png") + " " + image).status == 0);
  CHECK(load_image(directory.file("x.png")).width == 64);
  CHECK(
      run_roundel("detect --annotate " + directory.file("d") + " " + image + " " + video).status ==
      0);
  CHECK(load_image(directory.file("d/a_found.png")).width == 64);
  CHECK(load_image(directory.file("d/frame_000001.png")).width == 64);
  CHECK(load_image(directory.file("d/frame_000002.png")).width == 64);
  check_refused("detect --annotate " + directory.file("x.png") + " " + video, 2,
                "several frames need a directory");
}

TEST_CASE("output that can't be written is an error") {
  const TemporaryDirectory directory;
  const std::string image = grey_png(directory, "a.png", 64, 48);
  check_refused("detect --json " + image + " >/dev/full", 1, "standard output can't be written");
  check_refused("markers --id 1 -o /proc/m.pdf", 1, "/proc/m.pdf can't be written");
  check_refused("markers --id 1 -o /proc/m.svg", 1, "/proc/m.svg can't be written");
  check_refused("markers --id 1 -o /proc/m.png", 1, "/proc/m.png can't be written");
  check_refused("markers --id 1 -o /proc/m/", 1, "/proc/m/ can't be created");
}

TEST_CASE("sheets of several pages become one PDF or numbered pictures") {
  const TemporaryDirectory directory;
  const auto make = [&](const std::string& name) {
    return run_roundel("markers --ids 1-10 --dpi 50 -o " + directory.file(name)).status;
  };
  REQUIRE(make("m.pdf") == 0);
  CHECK(contains(run_command("pdfinfo " + directory.file("m.pdf")).out, "Pages:           10"));
  REQUIRE(make("m.png") == 0);
  REQUIRE(make("m.svg") == 0);
  for (const char* name : {"m-01.png", "m-10.png", "m-01.svg", "m-10.svg"}) {
    CHECK(std::filesystem::exists(directory.file(name)));
  }
  CHECK_FALSE(std::filesystem::exists(directory.file("m.png")));
}

TEST_CASE("a directory gets one file a marker") {
  const TemporaryDirectory directory;
  REQUIRE(run_roundel("markers --bits 5 --all --paper none --dpi 50 --format png -o " +
                      directory.file("all/"))
              .status == 0);
  for (int id = 1; id <= 6; ++id) {
    const GreyImage image =
        load_image(directory.file("all/5bits_id" + std::to_string(id) + ".png"));
    CHECK(image.width == 309);  // 122 mm * 899 / 700 at 50 dpi
  }
}

TEST_CASE("a PNG of a marker has the number of pixels asked for") {
  const TemporaryDirectory directory;
  for (const int pixels : {16, 101, 899}) {
    REQUIRE(run_roundel("markers --id 1 --pixels " + std::to_string(pixels) + " -o " +
                        directory.file("m.png"))
                .status == 0);
    const GreyImage image = load_image(directory.file("m.png"));
    CHECK(image.width == pixels);
    CHECK(image.height == pixels);
  }
}

TEST_CASE("a plain marker has the reference ratio unless told otherwise") {
  const TemporaryDirectory directory;
  const auto white_share = [&](const std::string& ratio) {
    REQUIRE(run_roundel("markers --plain " + ratio + " --pixels 1798 -o " + directory.file("m.png"))
                .status == 0);
    const GreyImage image = load_image(directory.file("m.png"));
    int white = 0;  // along the row through the centre, black disc of 1400 pixels
    for (int u = 199; u < 1599; ++u) {
      white += image.view().at(u, 899) > 128 ? 1 : 0;
    }
    return white / 1400.0;
  };
  CHECK(white_share("") == doctest::Approx(50.0 / 122).epsilon(0.002));
  CHECK(white_share("0.6") == doctest::Approx(0.6).epsilon(0.002));
}

}  // namespace roundel
