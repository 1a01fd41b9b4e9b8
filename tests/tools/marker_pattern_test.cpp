#include "tools/marker_pattern.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <numbers>
#include <string>

#include "core/necklace.hpp"
#include "tools/marker_sheet.hpp"
#include "tools/page_output.hpp"

namespace roundel {
namespace {

// A marker of one millimetre radius times `radius_px`, with its white margin.
GreyImage render(const MarkerPattern& pattern, double radius_px) {
  const PrintedMarker marker{pattern, "", ""};
  return render_page(bare_page(2), radius_px,
                     [&](cairo_t* context) { draw_bare_marker(context, marker, 2); });
}

// The printed pattern as MARKERS.md words it: is the point (in units of the black radius, x to
// 3 o'clock, y to 12 o'clock) white?
bool is_white(const MarkerPattern& pattern, double x, double y) {
  const double radius = std::hypot(x, y) * 700;
  if (radius > 700) {
    return true;
  }
  if (pattern.bits == 0) {
    return radius < pattern.plain_inner_ratio * 700;
  }
  if (radius > 420) {
    return false;
  }
  if (radius < 240) {
    return true;
  }
  double turn = std::atan2(y, x) / (2 * std::numbers::pi);
  turn -= std::floor(turn);
  const int half = static_cast<int>(turn * 2 * pattern.bits) % (2 * pattern.bits);
  const int bit = static_cast<int>(pattern.word >> (pattern.bits - 1 - half / 2) & 1U);
  return half % 2 == 0 ? bit == 1 : bit == 0;
}

double expected_grey(const MarkerPattern& pattern, double u, double v, double radius_px) {
  constexpr int kGrid = 8;
  const double middle = kMarginRatio * radius_px;
  int white = 0;
  for (int i = 0; i < kGrid; ++i) {
    for (int j = 0; j < kGrid; ++j) {
      const double x = (u + (i + 0.5) / kGrid - middle) / radius_px;
      const double y = (middle - v - (j + 0.5) / kGrid) / radius_px;
      white += is_white(pattern, x, y) ? 1 : 0;
    }
  }
  return 255.0 * white / (kGrid * kGrid);
}

// Largest and mean difference between what is drawn and what is worded.
void compare(const MarkerPattern& pattern, double radius_px) {
  const GreyImage image = render(pattern, radius_px);
  double worst = 0;
  double sum = 0;
  for (int v = 0; v < image.height; ++v) {
    for (int u = 0; u < image.width; ++u) {
      // The last row and column may reach over the page.
      const double grey = image.view().at(u, v);
      const double difference = std::abs(grey - expected_grey(pattern, u, v, radius_px));
      worst = std::max(worst, difference);
      sum += difference;
    }
  }
  CHECK(worst < 45);  // anti-aliasing where several edges meet in a pixel
  CHECK(sum / static_cast<double>(image.pixels.size()) < 0.5);
}

}  // namespace

TEST_CASE("every 8-bit marker is drawn as MARKERS.md words it") {
  const NecklaceCode code(8, 1);
  for (int id = 1; id <= code.id_count(); ++id) {
    CAPTURE(id);
    compare({8, code.word(id).value(), 0}, 60);
  }
}

TEST_CASE("markers of every code length and Hamming distance are drawn right") {
  for (int bits = kMinBits; bits <= kMaxBits; ++bits) {
    for (const int hamming : {1, kMaxHamming}) {
      const NecklaceCode code(bits, hamming);
      for (const int id : {1, code.id_count()}) {
        CAPTURE(bits);
        CAPTURE(id);
        compare({bits, code.word(id).value(), 0}, 80);
      }
    }
  }
}

TEST_CASE("plain markers have the white centre of their ratio") {
  for (const double ratio : {kPlainInnerRatioMin, kPlainInnerRatio, 0.4714, kPlainInnerRatioMax}) {
    CAPTURE(ratio);
    compare({0, 0, ratio}, 71.3);
  }
}

TEST_CASE("the drawn disc lies exactly in the middle and has exactly its size") {
  for (const double radius_px : {10.0, 20.37, 101.5}) {
    const GreyImage image = render({0, 0, 0.5}, radius_px);
    double dark = 0;
    double u_sum = 0;
    double v_sum = 0;
    for (int v = 0; v < image.height; ++v) {
      for (int u = 0; u < image.width; ++u) {
        const double weight = (255.0 - image.view().at(u, v)) / 255;
        dark += weight;
        u_sum += weight * u;
        v_sum += weight * v;
      }
    }
    CAPTURE(radius_px);
    const double middle = kMarginRatio * radius_px - 0.5;
    CHECK(u_sum / dark == doctest::Approx(middle).epsilon(0.01 / middle));
    CHECK(v_sum / dark == doctest::Approx(middle).epsilon(0.01 / middle));
    const double radius = std::sqrt(dark / (std::numbers::pi * (1 - 0.25)));
    CHECK(std::abs(radius - radius_px) < 0.01);
  }
}

TEST_CASE("black is black without seams where parts of the pattern meet") {
  const GreyImage image = render({8, 1, 0}, 200);  // word 1: teeth of one and of two halves
  const double middle = kMarginRatio * 200 - 0.5;
  int dark = 0;
  for (int step = 0; step < 3600; ++step) {
    const double angle = step * std::numbers::pi / 1800;
    const double place = std::fmod(angle, std::numbers::pi / 8) / (std::numbers::pi / 8);
    if (place < 0.1 || place > 0.9 ||
        is_white({8, 1, 0}, 0.5 * std::cos(angle), 0.5 * std::sin(angle))) {
      continue;  // only the middle of black half-teeth
    }
    ++dark;
    for (int i = 0; i < 155; ++i) {
      const double r = 0.36 + 0.004 * i;
      const int u = static_cast<int>(std::lround(middle + 200 * r * std::cos(angle)));
      const int v = static_cast<int>(std::lround(middle - 200 * r * std::sin(angle)));
      REQUIRE(int{image.view().at(u, v)} == 0);
    }
  }
  CHECK(dark > 1000);
}

}  // namespace roundel
