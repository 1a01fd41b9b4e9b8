#include "core/response_curve.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cstdint>

#include <stdexcept>

using namespace roundel;  // NOLINT(google-build-using-namespace)

TEST_CASE("a linear camera's grey levels are the light") {
  const ResponseCurve curve = ResponseCurve::linear();
  CHECK(curve.light(std::uint8_t{0}) == 0);
  CHECK(curve.light(std::uint8_t{128}) == doctest::Approx(128));
  CHECK(curve.slope(std::uint8_t{200}) == doctest::Approx(1));
}

TEST_CASE("sRGB's middle grey is a fifth of the light") {
  const ResponseCurve curve = ResponseCurve::srgb();
  CHECK(curve.light(std::uint8_t{255}) == doctest::Approx(255));
  CHECK(curve.light(std::uint8_t{128}) == doctest::Approx(0.2159 * 255).epsilon(0.001));
  CHECK(curve.light(std::uint8_t{5}) == doctest::Approx(5 / 12.92));
  // Dark levels are spread out, bright ones pressed together.
  CHECK(curve.slope(std::uint8_t{2}) == doctest::Approx(12.92).epsilon(0.001));
  CHECK(curve.slope(std::uint8_t{250}) < 0.6F);
}

TEST_CASE("many pixels at once get the light and the slope of each") {
  std::array<std::uint8_t, 256> grey{};
  for (std::size_t k = 0; k < grey.size(); ++k) grey[k] = static_cast<std::uint8_t>(255 - k);
  for (const ResponseCurve& curve :
       {ResponseCurve::linear(), ResponseCurve::srgb(), ResponseCurve::power(1.8)}) {
    std::array<float, 256> light{}, slopes{};
    curve.undo(grey.data(), grey.size(), light.data(), slopes.data());
    for (std::size_t k = 0; k < grey.size(); ++k) {
      CAPTURE(k);
      CHECK(light[k] == curve.light(grey[k]));
      CHECK(slopes[k] == curve.slope(grey[k]));
    }
  }
}

TEST_CASE("between grey levels the light is interpolated") {
  const ResponseCurve curve = ResponseCurve::power(2);
  CHECK(curve.light(100.5) ==
        doctest::Approx(0.5 * (static_cast<double>(curve.light(std::uint8_t{100})) +
                               static_cast<double>(curve.light(std::uint8_t{101})))));
  CHECK(curve.light(-3.0) == 0);
  CHECK(curve.light(300.0) == doctest::Approx(255));
}

TEST_CASE("a gamma that no camera has is refused") {
  CHECK_THROWS_AS(ResponseCurve::power(0), std::invalid_argument);
  CHECK_THROWS_AS(ResponseCurve::power(6), std::invalid_argument);
}

TEST_CASE("curves have names for the configuration") {
  REQUIRE(ResponseCurve::named("srgb").has_value());
  CHECK(ResponseCurve::named("srgb")->light(128.0) == ResponseCurve::srgb().light(128.0));
  CHECK(ResponseCurve::named("2.2")->light(128.0) == ResponseCurve::power(2.2).light(128.0));
  CHECK(ResponseCurve::named("linear")->light(77.0) == doctest::Approx(77));
  for (const char* wrong : {"", "sRGB ", "gamma", "0", "2.2x", "nan", "-1", "99"}) {
    CAPTURE(wrong);
    CHECK_FALSE(ResponseCurve::named(wrong).has_value());
  }
}
