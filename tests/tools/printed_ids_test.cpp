// Every marker that `roundel markers` draws is read again by the detector, in many sizes and turns.

#include <doctest/doctest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>

#include "core/detector.hpp"
#include "core/necklace.hpp"
#include "daemon/image_file.hpp"
#include "tests/pinhole.hpp"
#include "tests/tools/run_roundel.hpp"
#include "tools/marker_sheet.hpp"
#include "tools/page_output.hpp"

namespace roundel {
namespace {

constexpr double kDiameterMm = 122;
constexpr double kDegrees = 180 / std::numbers::pi;

struct Picture {
  GreyImage image;
  double diameter_px = 0;  // of the black disc
};

// The picture that `roundel markers --paper none` writes, read back from its PNG.
Picture printed(const TemporaryDirectory& directory, int bits, std::uint32_t word,
                double diameter_px) {
  const PrintedMarker marker{{bits, word, 0}, "", ""};
  write_png(directory.file("marker.png"), bare_page(kDiameterMm), diameter_px / kDiameterMm,
            [&](cairo_t* context) { draw_bare_marker(context, marker, kDiameterMm); });
  return {load_image(directory.file("marker.png")), diameter_px};
}

// std::floor is a function call on a plain x86-64, and this is called a billion times.
int floored(double x) {
  return static_cast<int>(x + 4096) - 4096;
}

// The picture made smaller, to this diameter of the black disc, and turned counter-clockwise about
// a point half a pixel or less off the middle: every pixel is the mean of the paper that it covers.
GreyImage scaled_and_turned(const Picture& master, double diameter_px, double turn,
                            double off_centre) {
  const double master_middle = 0.5 * master.diameter_px * kMarginRatio;
  const double scale = master.diameter_px / diameter_px;  // master pixels a pixel
  const LumaView paper = master.image.view();
  const int side = static_cast<int>(diameter_px * 1.5) + 16;
  const double middle = 0.5 * side + off_centre;
  const int samples = static_cast<int>(std::ceil(scale));
  const double c = std::cos(turn) * scale;
  const double s = std::sin(turn) * scale;
  GreyImage image;
  image.resize(side, side);
  std::uint8_t* pixel = image.pixels.data();
  for (int v = 0; v < side; ++v) {
    for (int u = 0; u < side; ++u, ++pixel) {
      int sum = 0;
      if (std::hypot(u - middle, v - middle) > diameter_px * kMarginRatio / 2 + 2) {
        *pixel = 255;  // off the paper
        continue;
      }
      for (int i = 0; i < samples * samples; ++i) {
        const int column = i % samples;
        const int row = i / samples;
        const double x = u + (column + 0.5) / samples - middle;
        const double y = v + (row + 0.5) / samples - middle;
        const int mu = floored(master_middle + c * x - s * y);
        const int mv = floored(master_middle + s * x + c * y);
        sum += paper.contains(mu, mv) ? paper.at(mu, mv) : 255;
      }
      *pixel = static_cast<std::uint8_t>(sum / (samples * samples));
    }
  }
  return image;
}

CameraModel camera_for(const GreyImage& image) {
  return test::pinhole(image.width, image.height, 1000);
}

// Counter-clockwise angle, as seen, of the marker's x axis from the image's right.
double turn_of(const Marker& marker) {
  const Eigen::Vector3d x = marker.pose.orientation * Eigen::Vector3d::UnitX();
  return std::atan2(-x.y(), x.x());
}

}  // namespace

TEST_CASE("all printed ids of 3 to 8 bits come back with id and turn, from 40 to 400 pixels") {
  const TemporaryDirectory directory;
  int read = 0;
  double worst = 0;
  for (int bits = 3; bits <= 8; ++bits) {
    const NecklaceCode code(bits, 1);
    DetectorParameters parameters;
    parameters.bits = bits;
    parameters.diameter_m = kDiameterMm / 1000;
    for (int id = 1; id <= code.id_count(); ++id) {
      const Picture large = printed(directory, bits, code.word(id).value(), 800);
      const Picture small = printed(directory, bits, code.word(id).value(), 320);
      for (const double diameter_px : {40.0, 71.3, 158.0, 400.0}) {
        const Picture& master = diameter_px > 160 ? large : small;
        for (int k = 0; k < 4; ++k) {
          const double turn = 2 * std::numbers::pi * std::fmod(0.37 * id + 0.241 * k, 1.0);
          const double off_centre = 0.25 * k - 0.375;
          const GreyImage image = scaled_and_turned(master, diameter_px, turn, off_centre);
          Detector detector(parameters, camera_for(image));
          const auto markers = detector.detect(image.view());
          CAPTURE(bits);
          CAPTURE(id);
          CAPTURE(diameter_px);
          CAPTURE(turn);
          REQUIRE(markers.size() == 1);
          CHECK(markers[0].id == id);
          const double error =
              std::abs(std::remainder(turn_of(markers[0]) - turn, 2 * std::numbers::pi));
          CHECK(kDegrees * error < 0.5);
          worst = std::max(worst, error);
          ++read;
        }
      }
    }
  }
  CHECK(read == 68 * 4 * 4);
  MESSAGE("largest error of turn: ", kDegrees * worst, " degrees in ", read, " pictures");
}

TEST_CASE("a marker printed by the tool is found by the tool") {
  const TemporaryDirectory directory;
  REQUIRE(run_roundel("markers --id 23 --pixels 300 -o " + directory.file("m.png")).status == 0);
  const auto frames = json_lines(run_roundel("detect --json " + directory.file("m.png")).out);
  REQUIRE(frames.size() == 1);
  const auto& markers = frames[0]["markers"];
  REQUIRE(markers.size() == 1);
  CHECK(markers[0]["id"] == 23);
  CHECK(markers[0]["u"] == doctest::Approx(149.5).epsilon(0.001));
  CHECK(markers[0]["v"] == doctest::Approx(149.5).epsilon(0.001));
  CHECK(markers[0]["ellipse"]["a"] == doctest::Approx(150 / kMarginRatio).epsilon(0.002));
  CHECK_FALSE(markers[0].contains("position"));
}

TEST_CASE("a whole printed sheet is read in one picture") {
  const TemporaryDirectory directory;
  REQUIRE(run_roundel("markers --bits 6 --all --diameter 0.05 --dpi 100 -o " +
                      directory.file("sheet.png"))
              .status == 0);
  const auto frames =
      json_lines(run_roundel("detect --json --bits 6 " + directory.file("sheet.png")).out);
  REQUIRE(frames.size() == 1);
  std::vector<int> ids;
  for (const auto& marker : frames[0]["markers"]) {
    ids.push_back(marker["id"]);
  }
  std::sort(ids.begin(), ids.end());
  CHECK(ids == std::vector{1, 2, 3, 4, 5, 6, 7, 8, 9});
}

}  // namespace roundel
