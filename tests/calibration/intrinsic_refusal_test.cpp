#include "calibration/intrinsic_refusal.hpp"

#include <doctest/doctest.h>

#include <limits>

#include "tests/calibration/synthetic_views.hpp"
#include "tests/error_of.hpp"

using namespace roundel;

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// A calibration with which all is well.
IntrinsicCalibration good() {
  IntrinsicCalibration calibration;
  calibration.camera = test::webcam();
  calibration.covariance.diagonal().setConstant(1e-4);
  calibration.error_px = 0.05;
  calibration.worst_px = 0.1;
  const test::SyntheticViews source(Board{}, test::webcam(), 1);
  for (const double tilt : {0.0, 0.4}) {
    ViewResult view;
    view.board_in_camera = source.pose({960, 540}, tilt, 0, 0, 0.5);
    calibration.views.push_back(view);
  }
  return calibration;
}

template <typename Change>
std::string refusal(Change&& change) {
  IntrinsicCalibration calibration = good();
  change(calibration);
  return error_of([&] { require_determined(calibration); });
}

}  // namespace

TEST_CASE("a calibration is refused for each thing that makes it worthless, with the numbers") {
  CHECK(refusal([](auto&) {}) == "");
  CHECK(refusal([](auto& c) { c.views.pop_back(); }).find("differ by 0.0 degrees") !=
        std::string::npos);
  CHECK(refusal([](auto& c) { c.error_px = 0.7; }).find("off by 0.70 pixels") != std::string::npos);
  CHECK(refusal([](auto& c) { c.error_px = kNan; }).find("no camera explains") !=
        std::string::npos);
  // 14.52 px of 1452.
  CHECK(refusal([](auto& c) {
          c.covariance(kFx, kFx) = 14.52 * 14.52;
        }).find("uncertain by 1 %, more than 0.5 %") != std::string::npos);
  CHECK(refusal([](auto& c) { c.covariance.setConstant(kNan); }).find("uncertain") !=
        std::string::npos);
  CHECK(refusal([](auto& c) {
          c.worst_px = std::numeric_limits<double>::infinity();
        }).find("folds back inside the picture") != std::string::npos);
}

TEST_CASE("views may be left out as long as most agree") {
  CHECK(error_of([] { require_agreement(15, 15); }) == "");
  CHECK(error_of([] { require_agreement(10, 15); }) == "");
  CHECK(error_of([] { require_agreement(9, 15); }).starts_with("6 of 15 views contradict"));
  CHECK(error_of([] { require_agreement(4, 5); }).starts_with("1 of 5 views contradict"));
}

TEST_CASE("a board that was not found is explained by what was found instead") {
  const auto reason = [](int markers, int foreign, int misplaced) {
    const BoardTally tally{3, 0, markers, foreign, misplaced};
    return error_of([&] { require_board(tally, Board{}); });
  };
  CHECK(reason(0, 0, 0).starts_with("no marker was found in any of 3 pictures"));
  CHECK(reason(2, 5, 0).starts_with("5 of 7 markers have ids that a board of 7 x 4"));
  CHECK(reason(20, 0, 15).starts_with("the markers do not lie as on a board of 7 columns"));
  CHECK(reason(5, 0, 0) == "");  // too few of them, as the number of views will tell
  CHECK(error_of([] { require_board({3, 1, 30, 0, 20}, Board{}); }) == "");
}
