#include "calibration/camera_file.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <random>
#include <string>

#include "calibration/bounded_yaml.hpp"
#include "tests/error_of.hpp"
#include "tests/temporary_directory.hpp"

using namespace roundel;

namespace {

const std::string kGolden = ROUNDEL_TEST_DATA "/camera_golden.yaml";
const std::string kOpenCv = ROUNDEL_TEST_DATA "/camera_opencv.yaml";

CameraFile golden_camera() {
  CameraFile file;
  file.name = "ceiling";
  file.camera.width = 1920;
  file.camera.height = 1080;
  file.camera.fx = 1452.25;
  file.camera.fy = 1455;
  file.camera.cx = 961.5;
  file.camera.cy = 538.125;
  file.camera.distortion = {-0.28, 0.09, 0.0006, -0.00001, -0.012};
  return file;
}

void check_same(const CameraModel& a, const CameraModel& b) {
  CHECK(a.width == b.width);
  CHECK(a.height == b.height);
  CHECK(a.fx == b.fx);
  CHECK(a.fy == b.fy);
  CHECK(a.cx == b.cx);
  CHECK(a.cy == b.cy);
  CHECK(a.distortion.k1 == b.distortion.k1);
  CHECK(a.distortion.k2 == b.distortion.k2);
  CHECK(a.distortion.p1 == b.distortion.p1);
  CHECK(a.distortion.p2 == b.distortion.p2);
  CHECK(a.distortion.k3 == b.distortion.k3);
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  REQUIRE(at != std::string::npos);
  return text.replace(at, what.size(), by);
}

// The error for the golden file with one piece of text replaced.
std::string error_with(const std::string& what, const std::string& by) {
  const std::string text = replaced(read_file(kGolden), what, by);
  return error_of([&] { parse_camera_file(text, "camera.yaml"); });
}

}  // namespace

TEST_CASE("a camera file is written as ROS's camera_calibration writes it") {
  CHECK(format_camera_file(golden_camera()) == read_file(kGolden));
}

TEST_CASE("a written camera file has every key that camera_calibration_parsers demands") {
  const YAML::Node file = YAML::Load(format_camera_file(golden_camera()));
  CHECK(file["image_width"].as<int>() == 1920);
  CHECK(file["image_height"].as<int>() == 1080);
  CHECK(file["camera_name"].as<std::string>() == "ceiling");
  CHECK(file["distortion_model"].as<std::string>() == "plumb_bob");
  for (const char* key :
       {"camera_matrix", "distortion_coefficients", "rectification_matrix", "projection_matrix"}) {
    CAPTURE(key);
    const auto size = file[key]["rows"].as<std::size_t>() * file[key]["cols"].as<std::size_t>();
    CHECK(file[key]["data"].as<std::vector<double>>().size() == size);
  }
  CHECK(file["projection_matrix"]["data"][0].as<double>() == 1452.25);
}

TEST_CASE("a ROS camera file is read") {
  const CameraFile file = read_camera_file(kGolden);
  CHECK(file.name == "ceiling");
  check_same(file.camera, golden_camera().camera);
}

TEST_CASE("an OpenCV FileStorage camera file is read") {
  const CameraFile file = read_camera_file(kOpenCv);
  CHECK(file.name.empty());
  CHECK(file.camera.width == 1280);
  CHECK(file.camera.height == 720);
  CHECK(file.camera.fx == 921.12345678901235);
  CHECK(file.camera.cy == 359.5);
  CHECK(file.camera.distortion.k1 == -0.28);
  CHECK(file.camera.distortion.k3 == -0.012);
}

TEST_CASE("comments stand above the keys and do not disturb a reader") {
  const std::vector<std::string> comments = {"made today: 15 views", "  fx 1452.25 ± 0.01 px"};
  const std::string text = format_camera_file(golden_camera(), comments);
  CHECK(text == "# made today: 15 views\n#   fx 1452.25 ± 0.01 px\n" + read_file(kGolden));
  check_same(parse_camera_file(text, "camera.yaml").camera, golden_camera().camera);
}

TEST_CASE("four coefficients mean that the fifth is zero") {
  const std::string text =
      replaced(replaced(read_file(kGolden), "cols: 5", "cols: 4"), ", -0.012]", "]");
  const CameraFile file = parse_camera_file(text, "camera.yaml");
  CHECK(file.camera.distortion.p2 == -0.00001);
  CHECK(file.camera.distortion.k3 == 0);
}

TEST_CASE("numbers survive writing and reading exactly") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> coefficient(-1, 1);
  std::uniform_real_distribution<double> focal(1e-3, 1e5);
  const TemporaryDirectory folder;
  for (int i = 0; i < 20; ++i) {
    CameraFile file = golden_camera();
    file.camera.fx = focal(random);
    file.camera.cx = focal(random);
    file.camera.distortion = {coefficient(random), coefficient(random) * 1e-9, coefficient(random),
                              coefficient(random), coefficient(random) * 1e9};
    write_camera_file(folder.file("camera.yaml"), file);
    check_same(read_camera_file(folder.file("camera.yaml")).camera, file.camera);
  }
}

TEST_CASE("a camera's name survives writing and reading, whatever it is") {
  for (const char* name : {"a", "no", "12", "C:\\cam \"1\"", "a: b # c", "über", ""}) {
    CAPTURE(name);
    CameraFile file = golden_camera();
    file.name = name;
    CHECK(parse_camera_file(format_camera_file(file), "camera.yaml").name == name);
  }
}

TEST_CASE("errors in a camera file name the file, the line, the key and what is right") {
  CHECK(error_with("image_width: 1920", "image_width: wide") ==
        "camera.yaml:1:14: image_width: must be a whole number of pixels from 1 to 65535");
  CHECK(error_with("image_height: 1080", "image_height: 0") ==
        "camera.yaml:2:15: image_height: must be a whole number of pixels from 1 to 65535");
  CHECK(error_with("image_height: 1080\n", "") ==
        "camera.yaml: image_height: is missing; intrinsics hold for one resolution, in pixels");
  CHECK(error_with("[1452.25,", "[-1452.25,") ==
        "camera.yaml:5:3: camera_matrix: focal lengths (the first and fifth number) must be "
        "positive");
  CHECK(error_with("[1452.25,", "[.nan,") ==
        "camera.yaml:7:10: camera_matrix: data must be finite numbers");
  CHECK(error_with("[1452.25, 0.0,", "[1452.25, 0.5,").find("skew") != std::string::npos);
  CHECK(error_with("rows: 3", "rows: 4") ==
        "camera.yaml:7:9: camera_matrix: data has 9 numbers, but rows times cols is 12");
  CHECK(error_with("rows: 3", "rows: -3") ==
        "camera.yaml:5:9: camera_matrix: rows must be a whole number from 1 to 100");
  CHECK(error_with("camera_matrix:", "matrix:").find("camera_matrix: is missing") !=
        std::string::npos);
  CHECK(error_with("camera_name: ceiling", "camera_name: [a]").find("camera_name: must be text") !=
        std::string::npos);
}

TEST_CASE("other lens models are refused by their name") {
  CHECK(error_with("distortion_model: plumb_bob", "distortion_model: equidistant") ==
        "camera.yaml:8:19: distortion_model: \"equidistant\" is not supported; calibrate with "
        "plumb_bob (k1, k2, p1, p2 and optionally k3)");
  const std::string eight = replaced(replaced(read_file(kGolden), "cols: 5", "cols: 8"), "-0.012]",
                                     "-0.012, 0.1, 0.2, 0.3]");
  const std::string error = error_of([&] { parse_camera_file(eight, "camera.yaml"); });
  CHECK(error.find("8 coefficients (rational_polynomial model) are not supported") !=
        std::string::npos);
  const std::string fisheye = replaced(read_file(kOpenCv), "fisheye_model: 0", "fisheye_model: 1");
  CHECK(error_of([&] {
          parse_camera_file(fisheye, "camera.yaml");
        }).find("fisheye is not supported") != std::string::npos);
}

TEST_CASE("a camera file of another resolution gets one clear error") {
  CHECK_NOTHROW(check_resolution(golden_camera().camera, 1920, 1080, "camera.yaml"));
  CHECK(error_of([] { check_resolution(golden_camera().camera, 1280, 720, "camera.yaml"); }) ==
        "camera.yaml: calibrated at 1920x1080, but the frames are 1280x720; use a calibration made "
        "at 1280x720, or frames of 1920x1080");
}

TEST_CASE("damaged camera files are errors, never crashes") {
  const std::string golden = read_file(kGolden), opencv = read_file(kOpenCv);
  constexpr std::string_view kNasty = "{}[]:,-&*!|>'\"%@`#?\n\t 0.eE~<\\";
  std::mt19937 random(11);
  int accepted = 0;
  for (int i = 0; i < 4000; ++i) {
    std::string text = i % 2 == 0 ? golden : opencv;
    for (unsigned change = 0; change <= random() % 8; ++change) {
      if (text.empty()) break;
      const std::size_t at = random() % text.size();
      switch (random() % 4) {
        case 0:
          text[at] = kNasty[random() % kNasty.size()];
          break;
        case 1:
          text.insert(at, 1, static_cast<char>(random() % 256));
          break;
        case 2:
          text.erase(at, 1 + random() % 20);
          break;
        default:
          text.resize(at + 1);
      }
    }
    try {
      const CameraFile file = parse_camera_file(text, "camera.yaml");
      REQUIRE(file.camera.fx > 0);
      REQUIRE(file.camera.width > 0);
      ++accepted;
    } catch (const std::runtime_error& error) {
      REQUIRE(std::string(error.what()).starts_with("camera.yaml:"));
    }
  }
  CHECK(accepted > 0);
  CHECK(accepted < 4000);
}
