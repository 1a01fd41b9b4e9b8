#include <doctest/doctest.h>

#include <cmath>

#include "simulator/renderer.hpp"
#include "simulator/response.hpp"
#include "tests/simulator/reference.hpp"

using namespace roundel;

namespace {

constexpr int kSize = 120;

Imaging ink_on_paper() {
  Imaging imaging;
  imaging.black = 0;
  imaging.white = imaging.floor = 255;
  return imaging;
}

// A disc of 40 pixels' radius, a little off the middle.
SceneMarker disc() {
  SceneMarker marker;
  marker.kind = MarkerKind::Disc;
  marker.diameter_m = 0.4;
  marker.pose = {{0.013, 0.008, 5}, reference::facing()};
  return marker;
}

CameraModel camera() {
  return reference::pinhole(kSize, kSize, 1000);
}

GreyImage picture(const Imaging& imaging, const SceneMarker& marker = disc()) {
  GreyImage image;
  Renderer(camera(), imaging).render({{}, {marker}, {}}, 0, image);
  return image;
}

GreyImage empty_floor(const Imaging& imaging) {
  GreyImage image;
  Renderer(camera(), imaging).render({}, 0, image);
  return image;
}

}  // namespace

TEST_CASE("blur keeps the light, leaves the centroid, and spreads by its variance") {
  Imaging imaging = ink_on_paper();
  const GreyImage sharp = picture(imaging);
  const auto before = reference::darkness(sharp, 0, 255);
  const auto spread_before = reference::spread(sharp, 0, 255);
  for (const double blur : {0.3, 0.5, 0.7, 1.0, 1.7, 3.0}) {
    CAPTURE(blur);
    imaging.blur_px = blur;
    const GreyImage blurred = picture(imaging);
    const auto after = reference::darkness(blurred, 0, 255);
    CHECK(after.area == doctest::Approx(before.area).epsilon(2e-4));
    CHECK((after.centroid - before.centroid).norm() < 0.003);
    const Eigen::Vector2d growth = reference::spread(blurred, 0, 255) - spread_before;
    // Rounding to grey levels: the variance of a disc of 40 pixels is known to about 0.1 px^2.
    CHECK(growth.x() == doctest::Approx(blur * blur).epsilon(0.02).scale(5));
    CHECK(growth.y() == doctest::Approx(blur * blur).epsilon(0.02).scale(5));
  }
}

TEST_CASE("a blurred straight edge is a Gaussian step over the pixel's width, wherever it lies") {
  // Expected grey of a pixel at distance d: the mean of the normal distribution function over it.
  const auto mean_step = [](double d, double sigma) {
    const auto integral = [&](double t) {
      const double z = t / sigma;
      return t * 0.5 * std::erfc(-z / std::sqrt(2.0)) +
             sigma * std::exp(-0.5 * z * z) / std::sqrt(2 * std::numbers::pi);
    };
    return integral(d + 0.5) - integral(d - 0.5);
  };
  for (const double blur : {0.35, 0.4, 0.5, 0.7, 0.9, 1.0, 1.3, 2.0, 3.0, 6.0}) {
    for (const double shift : {0.0, 0.13, 0.31, 0.5, 0.77}) {
      Imaging imaging = ink_on_paper();
      imaging.blur_px = blur;
      SceneShape paper;  // its left side is the edge; 100 pixels a metre here
      paper.outline = Outline::Rectangle;
      paper.grey = 0;
      paper.width_m = paper.height_m = 10;
      paper.pose = {{5 + shift / 100, 0, 10}, reference::facing()};
      GreyImage image;
      Renderer(camera(), imaging).render({{paper}, {}, {}}, 0, image);
      const double edge = camera().cx + shift;
      double worst = 0;
      for (int u = 30; u < 90; ++u) {
        const double expected = 255 * (1 - mean_step(u - edge, blur));
        worst = std::max(worst, std::abs(image.view().at(u, 60) - expected));
      }
      CAPTURE(blur);
      CAPTURE(shift);
      CHECK(worst < 0.5 + 0.004 * 255);  // rounding, and 0.4 % of the contrast
    }
  }
}

TEST_CASE("motion blur is centred on the middle of the exposure and as long as the way") {
  Imaging imaging = ink_on_paper();
  const auto still = reference::spread(picture(imaging), 0, 255);
  const auto place = reference::darkness(picture(imaging), 0, 255);
  imaging.exposure_s = 0.02;
  SceneMarker moving = disc();
  moving.velocity = {0.9, -0.3, 0};  // 200 pixels a metre here: 3.6 and 1.2 pixels
  const GreyImage image = picture(imaging, moving);
  const auto m = reference::darkness(image, 0, 255);
  CHECK((m.centroid - place.centroid).norm() < 0.003);
  CHECK(m.area == doctest::Approx(place.area).epsilon(1e-4));
  const Eigen::Vector2d growth = reference::spread(image, 0, 255) - still;
  CHECK(growth.x() == doctest::Approx(3.6 * 3.6 / 12).epsilon(0.03));
  CHECK(growth.y() == doctest::Approx(1.2 * 1.2 / 12).epsilon(0.03).scale(1));
  CHECK(picture(imaging).pixels == picture(ink_on_paper()).pixels);  // nothing moves: no blur
}

TEST_CASE("a turning marker smears its teeth but not its rim") {
  Imaging imaging = ink_on_paper();
  imaging.exposure_s = 0.05;
  SceneMarker marker = disc();
  marker.kind = MarkerKind::WhyCode;
  marker.word = 0b01010011;
  const GreyImage still = picture(imaging, marker);
  marker.spin = {0, 0, 4};  // 0.2 rad in the exposure: half a tooth
  const GreyImage turning = picture(imaging, marker);
  const double u0 = camera().cx + 2.6, v0 = camera().cy + 1.6;
  double rim = 0, ring = 0;
  for (int v = 0; v < kSize; ++v) {
    for (int u = 0; u < kSize; ++u) {
      const double change = std::abs(still.view().at(u, v) - turning.view().at(u, v));
      const double rho = std::hypot(u - u0, v - v0) / 40;
      if (rho > 0.7) rim = std::max(rim, change);
      if (rho > 0.4 && rho < 0.55) ring = std::max(ring, change);
    }
  }
  CHECK(rim <= 1);
  CHECK(ring > 80);
}

TEST_CASE("edges mix in linear light whatever the response curve, and flat areas keep their grey") {
  const auto power = [](double grey) { return std::pow(grey / 255, 2.2); };
  const auto srgb = [](double grey) {
    const double g = grey / 255;
    return g <= 0.04045 ? g / 12.92 : std::pow((g + 0.055) / 1.055, 2.4);
  };
  Imaging imaging;
  const auto dark_area = [&](const GreyImage& image, auto decode) {
    const double dark = decode(35.0), bright = decode(215.0);
    double area = 0;
    for (int v = 0; v < kSize; ++v) {
      for (int u = 0; u < kSize; ++u) {
        if (std::hypot(u - 62.1, v - 61.1) > 46) continue;  // the plate's white only
        area += (bright - decode(image.view().at(u, v))) / (bright - dark);
      }
    }
    return area;
  };
  const double truth = std::numbers::pi * 40 * 40;
  CHECK(dark_area(picture(imaging), [](double g) { return g; }) ==
        doctest::Approx(truth).epsilon(2e-4));

  imaging.gamma = 2.2;
  const GreyImage curved = picture(imaging);
  CHECK(dark_area(curved, power) == doctest::Approx(truth).epsilon(3e-4));
  // METHOD.md section 9.5: read without knowing the curve, dark areas shrink.
  CHECK(dark_area(curved, [](double g) { return g; }) < truth - 30);
  CHECK(curved.view().at(62, 61) == 35);
  CHECK(curved.view().at(62, 61 - 45) == 215);
  CHECK(curved.view().at(2, 2) == 120);

  imaging.srgb = true;
  CHECK(dark_area(picture(imaging), srgb) == doctest::Approx(truth).epsilon(3e-4));
}

TEST_CASE("the response's table is as good as its formula") {
  for (const bool srgb : {false, true}) {
    const Response response(2.2, srgb);
    for (int k = 0; k <= 6800; ++k) {
      const double light = 0.0375 * k;
      const auto in = static_cast<float>(light);
      std::int16_t out = 0;
      response.encode(&in, &out, 1);
      const double grey = static_cast<double>(out) / Response::kFixedOne;
      CHECK(std::abs(grey - response.grey_of_light(light)) < 0.03);
      CHECK(response.light_of_grey(response.grey_of_light(light)) == doctest::Approx(light));
    }
  }
}

TEST_CASE("a light gradient is linear across the image and 1 in its middle") {
  Imaging imaging;
  imaging.floor = 100;
  imaging.gradient = 0.5;
  const auto along_u = empty_floor(imaging);
  CHECK(along_u.view().at(0, 60) == 75);  // 100 (1 - 0.25), and half a pixel
  CHECK(along_u.view().at(kSize - 1, 3) == 125);
  CHECK(along_u.view().at(60, 60) == 100);
  imaging.gradient_angle = std::numbers::pi / 2;
  const auto along_v = empty_floor(imaging);
  CHECK(along_v.view().at(7, 0) == 75);
  CHECK(along_v.view().at(90, kSize - 1) == 125);
}

TEST_CASE("a shadow darkens one side of its edge, and the edge is hard") {
  Imaging imaging;
  imaging.floor = 200;
  imaging.shadow_factor = 0.4;
  imaging.shadow_u = 50.25;
  imaging.shadow_v = 10;
  const auto image = empty_floor(imaging);
  CHECK(image.view().at(49, 60) == 200);
  CHECK(image.view().at(51, 60) == 80);
  CHECK(image.view().at(50, 60) == 170);  // a quarter of the pixel lies in the shadow
  imaging.shadow_angle = std::numbers::pi;
  const auto other = empty_floor(imaging);
  CHECK(other.view().at(49, 60) == 80);
  CHECK(other.view().at(51, 60) == 200);
}

TEST_CASE("light and shadow multiply what they fall on") {
  Imaging imaging;
  imaging.black = 40;
  imaging.white = 200;
  imaging.shadow_factor = 0.5;
  imaging.shadow_u = 60;
  const auto image = picture(imaging);
  CHECK(image.view().at(75, 61) == 20);
  CHECK(image.view().at(40, 61) == 40);
  CHECK(image.view().at(62, 61 - 45) == 100);
  CHECK(image.view().at(55, 61 - 45) == 200);
}
