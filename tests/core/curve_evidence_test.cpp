#include "core/curve_evidence.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>

using namespace roundel;  // NOLINT(google-build-using-namespace)

namespace {

// A marker whose squares are least at `true_exponent`, by a parabola of the given deviation.
void show(CurveEvidence& evidence, double true_exponent, double sigma, int markers) {
  for (int i = 0; i < markers; ++i) {
    std::array<double, 3> squares{};
    for (std::size_t k = 0; k < 3; ++k) {
      const double exponent =
          evidence.centre() + (static_cast<double>(k) - 1) * CurveEvidence::kProbe;
      const double off = (exponent - true_exponent) / sigma;
      squares[k] = 1000 + off * off;
    }
    evidence.add(squares);
  }
}

}  // namespace

TEST_CASE("without evidence a camera is linear") {
  CurveEvidence evidence;
  CHECK(evidence.exponent() == 1);
  show(evidence, 1.05, 0.1, 200);
  CHECK(evidence.exponent() == 1);
}

TEST_CASE("a few markers that know little change nothing") {
  CurveEvidence evidence;
  show(evidence, 2.4, 1.0, 3);
  CHECK(evidence.exponent() == 1);
}

TEST_CASE("a curve is found from the evidence of many markers, however far") {
  CurveEvidence evidence;
  show(evidence, 2.4, 0.15, 60);
  CHECK(evidence.exponent() == doctest::Approx(2.4).epsilon(0.03));
  SUBCASE("and left again when the camera changes it") {
    show(evidence, 1.0, 0.15, 300);
    CHECK(evidence.exponent() == 1);
  }
  SUBCASE("and forgotten when asked to") {
    evidence.forget();
    CHECK(evidence.exponent() == 1);
  }
}

TEST_CASE("squares that are no numbers are no evidence") {
  CurveEvidence evidence;
  evidence.add({0.0, NAN, 1.0});
  CHECK(evidence.exponent() == 1);
  CHECK(evidence.centre() == 1);
}
