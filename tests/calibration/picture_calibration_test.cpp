// Show 2 of the arena's issue: a camera from 15 pictures of a board, noise 2. The deviations over
// 50 repetitions: ROUNDEL_REPETITIONS=50 build/release/bin/board_tests -tc='a camera is found*'

#include "calibration/picture_calibration.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "calibration/intrinsic_parameters.hpp"
#include "tests/calibration/board_pictures.hpp"
#include "tests/calibration/synthetic_views.hpp"
#include "tests/error_of.hpp"

using namespace roundel;
using namespace roundel::test;

namespace {

int repetitions() {
  const char* text = std::getenv("ROUNDEL_REPETITIONS");
  return text == nullptr ? 1 : std::max(1, std::atoi(text));
}

struct Worst {
  double focal = 0, centre_px = 0, error_px = 0;
};

}  // namespace

TEST_CASE(
    "a camera is found from 15 pictures: focal length to 0.1 %, centre to 1 px, error 0.05 px") {
  const CameraModel truth = webcam();
  const Board board;
  const int count = repetitions();
  IntrinsicVector squares = IntrinsicVector::Zero();
  Worst worst;
  for (int i = 0; i < count; ++i) {
    const auto seed = static_cast<std::uint64_t>(i);
    BoardCamera camera(board, truth, imaging(), derived_seed(1, seed));
    const auto images = camera.take(board_poses(board, truth, 15, derived_seed(77, seed)));
    const auto calibration = calibrate_from_pictures(views_of(images), board, {});
    const IntrinsicCalibration& found = calibration.result;
    CHECK(calibration.rounds > 1);
    CHECK(calibration.last_change_px < 0.01);
    CHECK(found.views.size() == 15);
    worst.focal = std::max({worst.focal, std::abs(found.camera.fx / truth.fx - 1),
                            std::abs(found.camera.fy / truth.fy - 1)});
    worst.centre_px = std::max({worst.centre_px, std::abs(found.camera.cx - truth.cx),
                                std::abs(found.camera.cy - truth.cy)});
    worst.error_px = std::max(worst.error_px, found.error_px);
    squares +=
        (to_vector(found.camera) - to_vector(truth)).cwiseQuotient(found.sigma()).cwiseAbs2();
  }
  CHECK(worst.focal < 0.001);
  CHECK(worst.centre_px < 1);
  CHECK(worst.error_px < 0.05);
  std::string ratios;
  for (int k = 0; k < kIntrinsicParameters; ++k) {
    const double ratio = std::sqrt(squares[k] / count);
    ratios += fmt::format(" {} {:.2f}", kIntrinsicNames[static_cast<std::size_t>(k)], ratio);
    // A ratio from n repetitions scatters by 1 / sqrt(2 n): within four of these.
    CHECK(ratio < 1 + 4 / std::sqrt(2.0 * count));
    if (count >= 20) CHECK(ratio > 1 - 4 / std::sqrt(2.0 * count));
  }
  // All nine together scatter less.
  const double together = std::sqrt(squares.mean() / count);
  ratios += fmt::format(", together {:.2f}", together);
  if (count >= 50) CHECK(together == doctest::Approx(1).epsilon(0.1));
  MESSAGE(count, " repetitions, worst: focal length ", fmt::format("{:.5f}", 100 * worst.focal),
          " %, principal point ", fmt::format("{:.4f}", worst.centre_px), " px, total error ",
          fmt::format("{:.4f}", worst.error_px), " px; errors in stated deviations:", ratios);
}

TEST_CASE("gamma, soft focus and a cheap sensor do not hurt much") {
  const CameraModel truth = small_webcam();
  const Board board;
  Imaging cheap = imaging(5, 1.2);
  cheap.srgb = true;
  cheap.gradient = 0.4;
  BoardCamera camera(board, truth, cheap);
  const auto images = camera.take(board_poses(board, truth, 15, 3));
  const auto found = calibrate_from_pictures(views_of(images), board, {}).result;
  CHECK(found.camera.fx == doctest::Approx(truth.fx).epsilon(1e-3));
  CHECK(std::abs(found.camera.cx - truth.cx) < 0.5);
  CHECK(std::abs(found.camera.cy - truth.cy) < 0.5);
  CHECK(found.error_px < 0.05);
}

TEST_CASE("pictures without a board, or with another one, are refused with the reason") {
  const CameraModel truth = small_webcam();
  GreyImage empty;
  empty.resize(640, 360);
  std::fill(empty.pixels.begin(), empty.pixels.end(), std::uint8_t{90});
  const std::vector<LumaView> nothing(7, empty.view());
  CHECK(error_of([&] {
          calibrate_from_pictures(nothing, Board{}, {});
        }).starts_with("no marker was found in any of 7 pictures; the board is printed by"));
  CHECK(error_of([&] { calibrate_from_pictures({}, Board{}, {}); }) ==
        "there is no picture to calibrate with");

  BoardCamera camera(Board{}, truth, imaging());
  const auto images = camera.take(board_poses(Board{}, truth, 6, 9));
  Board other;
  other.columns = 4;
  other.rows = 7;
  CHECK(
      error_of([&] { calibrate_from_pictures(views_of(images), other, {}); }) ==
      "the markers do not lie as on a board of 4 columns and 7 rows: --columns and --rows must be "
      "as printed");
  Board small;
  small.columns = 3;
  small.rows = 2;
  CHECK(error_of([&] {
          calibrate_from_pictures(views_of(images), small, {});
        }).find("have ids that a board of 3 x 2 does not have (1 to 6)") != std::string::npos);
  Board bits;
  bits.bits = 10;
  CHECK(error_of([&] { calibrate_from_pictures(views_of(images), bits, {}); }) != "");

  // Mirrored, as some webcam programs show their owner.
  auto mirrored = images;
  for (GreyImage& image : mirrored) {
    for (int v = 0; v < image.height; ++v) {
      const auto row = image.pixels.begin() + static_cast<std::ptrdiff_t>(v) * image.width;
      std::reverse(row, row + image.width);
    }
  }
  const std::string error =
      error_of([&] { calibrate_from_pictures(views_of(mirrored), Board{}, {}); });
  CAPTURE(error);
  CHECK(error != "");
}
