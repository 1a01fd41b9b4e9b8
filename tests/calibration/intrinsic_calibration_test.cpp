#include "calibration/intrinsic_calibration.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "calibration/intrinsic_start.hpp"
#include "calibration/print_quality.hpp"
#include "calibration/projection_uncertainty.hpp"
#include "tests/calibration/synthetic_views.hpp"
#include "tests/error_of.hpp"
#include "tests/random.hpp"
#include "tests/slow_build.hpp"

using namespace roundel;
using test::SyntheticViews;

namespace {

IntrinsicCalibration calibrate(const SyntheticViews& source, const std::vector<BoardView>& views,
                               const IntrinsicOptions& options = {}) {
  return calibrate_intrinsics(views, source.camera.width, source.camera.height, options);
}

// Errors in stated standard deviations.
IntrinsicVector normalised_errors(const IntrinsicCalibration& found, const CameraModel& truth) {
  return (to_vector(found.camera) - to_vector(truth)).cwiseQuotient(found.sigma());
}

CameraModel camera_of(double focal, int width, int height, const Distortion& distortion) {
  CameraModel camera;
  camera.width = width;
  camera.height = height;
  camera.fx = focal;
  camera.fy = 1.003 * focal;
  camera.cx = 0.51 * width;
  camera.cy = 0.48 * height;
  camera.distortion = distortion;
  return camera;
}

}  // namespace

TEST_CASE("without noise any camera is found exactly, from nothing known") {
  struct Lens {
    double focal;  // of the picture's width
    Distortion distortion;
  };
  int seed = 0;
  for (const Lens& lens : {Lens{0.5, {-0.2, 0.03, 0.0005, -0.0005, 0}},
                           Lens{0.76, {-0.28, 0.09, 0.0006, -0.0009, -0.012}},
                           Lens{1.5, {0.1, -0.3, 0.001, 0.002, 0.1}}, Lens{4, {}}}) {
    for (const auto& [width, height] : {std::pair(1920, 1080), std::pair(480, 640)}) {
      CAPTURE(lens.focal);
      CAPTURE(width);
      SyntheticViews source(Board{}, camera_of(lens.focal * width, width, height, lens.distortion),
                            static_cast<std::uint64_t>(++seed));
      const auto result = calibrate(source, source.varied_views(15, 0));
      CHECK(result.camera.fx == doctest::Approx(source.camera.fx).epsilon(1e-6));
      CHECK(result.camera.fy == doctest::Approx(source.camera.fy).epsilon(1e-6));
      CHECK(std::abs(result.camera.cx - source.camera.cx) < 0.01);
      CHECK(std::abs(result.camera.cy - source.camera.cy) < 0.01);
      CHECK(std::abs(result.camera.distortion.k1 - source.camera.distortion.k1) < 1e-3);
      CHECK(std::abs(result.camera.distortion.p1 - source.camera.distortion.p1) < 1e-5);
      CHECK(result.error_px < 1e-4);
      CHECK(result.outliers == 0);
      CHECK(result.views.size() == 15);
    }
  }
}

TEST_CASE("stated deviations are honest: with an exact board and with one that must be estimated") {
  constexpr int kRepetitions = test::kSlow ? 10 : 40;
  // A deviation of deviations is 1 / sqrt(2 n): within three of them.
  const double tolerance = 3 / std::sqrt(2.0 * kRepetitions);
  for (const bool exact : {true, false}) {
    CAPTURE(exact);
    IntrinsicOptions options;
    options.exact_board = exact;
    IntrinsicVector squares = IntrinsicVector::Zero();
    double sigma_sum = 0;
    for (int i = 0; i < kRepetitions; ++i) {
      SyntheticViews source(Board{}, test::webcam(), 100 + static_cast<std::uint64_t>(i));
      const auto result = calibrate(source, source.varied_views(12, 0.05), options);
      squares += normalised_errors(result, source.camera).cwiseAbs2();
      sigma_sum += result.residual_sigma;
    }
    for (int k = 0; k < kIntrinsicParameters; ++k) {
      CAPTURE(kIntrinsicNames[static_cast<std::size_t>(k)]);
      const double ratio = std::sqrt(squares[k] / kRepetitions);
      CHECK(std::abs(ratio - 1) < tolerance);
    }
    // The views said 0.02 px and had 0.05.
    CHECK(sigma_sum / kRepetitions == doctest::Approx(2.5).epsilon(0.03));
  }
}

TEST_CASE("deviations are honest where points differ much, and share more than was stated") {
  constexpr int kRepetitions = test::kSlow ? 10 : 60;
  constexpr double kScale = 1.5, kFloorPx = 0.006;
  test::Random random(8);
  IntrinsicVector squares = IntrinsicVector::Zero();
  double scale_sum = 0, floor_sum = 0;
  for (int i = 0; i < kRepetitions; ++i) {
    SyntheticViews source(Board{}, test::webcam(), 300 + static_cast<std::uint64_t>(i));
    std::vector<BoardView> views = source.varied_views(15, 0);
    for (BoardView& view : views) {
      for (BoardPoint& point : view.points) {
        const double own = 0.001 * std::exp(random.uniform(0, 4));  // to 0.055 px
        const double sigma = std::hypot(kScale * own, kFloorPx);
        point.pixel += sigma * Eigen::Vector2d(random.gaussian(), random.gaussian());
        point.covariance = Eigen::Matrix2d::Identity() * own * own;
      }
    }
    const auto result = calibrate(source, views);
    squares += normalised_errors(result, source.camera).cwiseAbs2();
    scale_sum += result.residual_sigma;
    floor_sum += result.floor_px;
  }
  const double count = kRepetitions;
  for (int k = 0; k < kIntrinsicParameters; ++k) {
    CAPTURE(kIntrinsicNames[static_cast<std::size_t>(k)]);
    CHECK(std::abs(std::sqrt(squares[k] / count) - 1) < 3.5 / std::sqrt(2 * count));
  }
  // All together scatter less; with points weighed alike it is 1.2 and more.
  CHECK(std::sqrt(squares.mean() / count) == doctest::Approx(1).epsilon(test::kSlow ? 0.2 : 0.1));
  CHECK(scale_sum / count == doctest::Approx(kScale).epsilon(0.1));
  CHECK(floor_sum / count == doctest::Approx(kFloorPx).epsilon(0.1));
}

TEST_CASE("a sloppy, bent print costs little, and is found out") {
  IntrinsicVector squares = IntrinsicVector::Zero();
  constexpr int kRepetitions = test::kSlow ? 4 : 20;
  for (int i = 0; i < kRepetitions; ++i) {
    SyntheticViews source(Board{}, test::webcam(), 300 + static_cast<std::uint64_t>(i));
    test::Random random(static_cast<std::uint64_t>(i));
    for (Eigen::Vector3d& place : source.places) {
      place += 1e-4 * Eigen::Vector3d(random.gaussian(), random.gaussian(), 0);
      place.y() *= 1.002;
      place.z() = 0.0015 * (1 - place.x() * place.x() / 0.0144);
    }
    const auto result = calibrate(source, source.varied_views(15, 0.02));
    CHECK(std::abs(result.camera.fx / source.camera.fx - 1) < 1e-3);
    CHECK(result.error_px < 0.05);
    squares += normalised_errors(result, source.camera).cwiseAbs2();
    const PrintQuality print = print_quality(source.board, result.offsets);
    CHECK(print.stretch == doctest::Approx(0.002).epsilon(0.2));
    CHECK(print.flatness_m == doctest::Approx(0.0015).epsilon(0.1));
  }
  for (int k = 0; k < kIntrinsicParameters; ++k) {
    CAPTURE(kIntrinsicNames[static_cast<std::size_t>(k)]);
    CHECK(std::sqrt(squares[k] / kRepetitions) < 1 + 3 / std::sqrt(2.0 * kRepetitions));
  }
}

TEST_CASE("wrong markers are left out and change nothing") {
  SyntheticViews source(Board{}, test::webcam(), 5);
  auto views = source.varied_views(15, 0.02);
  test::Random random(6);
  int wrong = 0;
  for (BoardView& view : views) {
    for (BoardPoint& point : view.points) {
      if (random.integer(0, 19) != 0) continue;
      point.pixel += Eigen::Vector2d(random.uniform(0.5, 20), random.uniform(-20, -0.5));
      ++wrong;
    }
  }
  REQUIRE(wrong > 10);
  const auto result = calibrate(source, views);
  CHECK(result.outliers >= wrong);
  CHECK(result.outliers <= wrong + 4);
  CHECK(result.error_px < 0.04);
  CHECK(normalised_errors(result, source.camera).cwiseAbs().maxCoeff() < 4);
}

TEST_CASE("a view that contradicts all others is left out as a whole") {
  SyntheticViews source(Board{}, test::webcam(), 7);
  auto views = source.varied_views(15, 0.02);
  for (BoardPoint& point : views[4].points)  // as a rolling shutter skews a moving board
    point.pixel.x() += 0.01 * point.pixel.y() + 1e-5 * point.pixel.y() * point.pixel.y();
  const auto result = calibrate(source, views);
  CHECK(result.views.size() == 14);
  CHECK(std::none_of(result.views.begin(), result.views.end(),
                     [](const ViewResult& view) { return view.picture == 4; }));
  CHECK(normalised_errors(result, source.camera).cwiseAbs().maxCoeff() < 4);
}

TEST_CASE("a lens without its third coefficient has none") {
  SyntheticViews source(Board{}, test::webcam(), 9);
  IntrinsicOptions options;
  options.estimate_k3 = false;
  const auto result = calibrate(source, source.varied_views(15, 0.02), options);
  CHECK(result.camera.distortion.k3 == 0);
  CHECK(result.sigma()[kK3] == 0);
  CHECK(result.sigma()[kK2] > 0);
}

TEST_CASE("too few views are refused") {
  SyntheticViews source(Board{}, test::webcam(), 11);
  auto views = source.varied_views(15, 0.02);
  for (std::size_t i = 4; i < views.size(); ++i) views[i].points.resize(5);
  CHECK(
      error_of([&] { calibrate(source, views); }) ==
      "only 4 of 15 pictures show at least 6 markers of the board; at least 5 are needed, some 15 "
      "are good");
  CHECK(error_of([&] { calibrate(source, {}); }).starts_with("none of 0 pictures"));
}

TEST_CASE("views that are all alike or all frontal are refused") {
  SyntheticViews source(Board{}, test::webcam(), 12);
  test::Random random(1);
  const auto views_of = [&](double most_tilt, double share) {
    std::vector<BoardView> views;
    for (int i = 0; i < 15; ++i) {
      views.push_back(
          source.view(i,
                      source.pose({random.uniform(700, 1250), random.uniform(400, 680)},
                                  random.uniform(0, most_tilt), random.uniform(0, 6.28), 0, share),
                      0.02));
    }
    return views;
  };
  const std::string frontal = error_of([&] { calibrate(source, views_of(0.03, 0.8)); });
  CAPTURE(frontal);
  CHECK(frontal.find("nearly the same angle") != std::string::npos);
  CHECK(frontal.find("tilted by 20 to 45 degrees") != std::string::npos);
  CHECK(error_of([&] { calibrate(source, views_of(0.6, 0.8)); }) == "");  // the same, but tilted
}

TEST_CASE("a board that never left the middle of the picture is refused, and told where to go") {
  SyntheticViews source(Board{}, test::webcam(), 13);
  test::Random random(1);
  std::vector<BoardView> views;
  for (int i = 0; i < 15; ++i) {
    views.push_back(source.view(
        i, source.pose({960, 540}, 0.5, random.uniform(0, 6.28), random.uniform(0, 6.28), 0.2),
        0.02));
  }
  const std::string error = error_of([&] { calibrate(source, views); });
  CAPTURE(error);
  CHECK(error.starts_with(
      "the board was never seen in these parts of the picture: upper left, top,"));
  CHECK(error.find("lower right") != std::string::npos);
}

TEST_CASE("a zoom in the middle of the series is refused") {
  SyntheticViews source(Board{}, test::webcam(), 14);
  auto views = source.varied_views(15, 0.02);
  source.camera.fx *= 1.1;
  source.camera.fy *= 1.1;
  const auto zoomed = source.varied_views(15, 0.02);
  std::copy(zoomed.begin() + 7, zoomed.end(), views.begin() + 7);
  const std::string error = error_of([&] { calibrate(source, views); });
  CAPTURE(error);
  CHECK(error.find("focus, zoom and size of the pictures must stay the same") != std::string::npos);
}

TEST_CASE("the focal length follows from tilted views alone, and from frontal ones not") {
  CameraModel camera = test::webcam();
  camera.distortion = {};
  SyntheticViews source(Board{}, camera, 15);
  const auto focal = focal_from_homographies(source.varied_views(10, 0.01), 1920, 1080);
  REQUIRE(focal);
  CHECK(*focal == doctest::Approx(1453).epsilon(0.03));
  std::vector<BoardView> frontal;
  for (int i = 0; i < 3; ++i)
    frontal.push_back(source.view(i, source.pose({960, 540}, 0, 0, 0.1 * i, 0.5), 0));
  const auto none = focal_from_homographies(frontal, 1920, 1080);
  CHECK((!none || std::abs(*none / 1453 - 1) > 0.05));
  CHECK_FALSE(focal_from_homographies({}, 1920, 1080));
}

TEST_CASE("the stated uncertainty at a place of the picture is that of repeated calibrations") {
  constexpr int kRepetitions = test::kSlow ? 12 : 30;
  std::vector<PlaceUncertainty> stated;
  std::vector<double> squares;
  for (int i = 0; i < kRepetitions; ++i) {
    SyntheticViews source(Board{}, test::webcam(), 500 + static_cast<std::uint64_t>(i));
    IntrinsicOptions options;
    options.exact_board = true;
    const auto result = calibrate(source, source.varied_views(12, 0.05), options);
    stated = projection_uncertainty(result.camera, result.covariance);
    squares.resize(stated.size(), 0);
    // The turn of the camera that brings the directions of both cameras together, by small angles.
    std::vector<Eigen::Vector3d> found, truth;
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (const PlaceUncertainty& place : stated) {
      found.push_back(result.camera.normalise(place.pixel)->homogeneous().normalized());
      truth.push_back(source.camera.normalise(place.pixel)->homogeneous().normalized());
      spread += truth.back() * found.back().transpose();
    }
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(spread, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const Eigen::Matrix3d turn = svd.matrixU() * svd.matrixV().transpose();
    for (std::size_t k = 0; k < stated.size(); ++k) {
      const auto pixel = source.camera.project(turn * found[k]);
      REQUIRE(pixel);
      squares[k] += (*pixel - stated[k].pixel).squaredNorm();
    }
  }
  // The stated deviation is along the worse axis, the measured one over both; views differ.
  for (std::size_t k = 0; k < stated.size(); ++k) {
    CAPTURE(stated[k].pixel.transpose());
    const double ratio = std::sqrt(squares[k] / kRepetitions) / stated[k].sigma_px;
    CHECK(ratio > 0.3);
    CHECK(ratio < 3);
  }
  const auto worst =
      std::max_element(stated.begin(), stated.end(),
                       [](const auto& a, const auto& b) { return a.sigma_px < b.sigma_px; });
  CHECK((worst->pixel.x() < 1 || worst->pixel.x() > 1918));  // at the border
}
