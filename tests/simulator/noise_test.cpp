#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "simulator/renderer.hpp"
#include "tests/simulator/reference.hpp"

using namespace roundel;

namespace {

constexpr int kWidth = 1280, kHeight = 720;

// Deviations of a flat floor of grey 120.
std::vector<double> deviations(Renderer& renderer, std::uint64_t seed) {
  GreyImage image;
  renderer.render({}, seed, image);
  std::vector<double> noise(image.pixels.size());
  for (std::size_t i = 0; i < noise.size(); ++i) noise[i] = image.pixels[i] - 120.0;
  return noise;
}

double mean_product(const std::vector<double>& a, const std::vector<double>& b, int du, int dv) {
  double sum = 0;
  int count = 0;
  const std::ptrdiff_t shift = std::ptrdiff_t{dv} * kWidth + du;
  for (int v = 0; v + dv < kHeight; ++v) {
    const double* from = a.data() + std::ptrdiff_t{v} * kWidth;
    const double* to = b.data() + std::ptrdiff_t{v} * kWidth + shift;
    for (int u = 0; u + du < kWidth; ++u, ++count) sum += from[u] * to[u];
  }
  return sum / count;
}

}  // namespace

TEST_CASE("noise has the mean, the sigma and the shape of the normal distribution") {
  for (const double sigma : {1.0, 3.0, 10.0}) {
    CAPTURE(sigma);
    Renderer renderer(reference::pinhole(kWidth, kHeight, 1000), {.noise_sigma = sigma});
    const auto noise = deviations(renderer, 5);
    const auto count = static_cast<double>(noise.size());
    double sum = 0, squares = 0, fourths = 0, beyond = 0;
    for (const double n : noise) {
      sum += n;
      squares += n * n;
      fourths += n * n * n * n;
      beyond += std::abs(n) > 3 * sigma + 0.5 ? 1 : 0;
    }
    const double variance = squares / count;
    // Four standard errors of the mean; rounding to whole levels adds 1/12 to the variance.
    CHECK(std::abs(sum / count) < 4 * sigma / std::sqrt(count));
    CHECK(variance == doctest::Approx(sigma * sigma + 1.0 / 12).epsilon(0.008));
    CHECK(fourths / count / (variance * variance) == doctest::Approx(3).epsilon(0.03));
    if (sigma == 10.0) CHECK(beyond / count == doctest::Approx(0.0026).epsilon(0.15));
  }
}

TEST_CASE("noise is white, within a frame and from frame to frame") {
  Renderer renderer(reference::pinhole(kWidth, kHeight, 1000), {.noise_sigma = 4});
  const auto frame = deviations(renderer, 1), next = deviations(renderer, 2);
  const double variance = mean_product(frame, frame, 0, 0);
  const double bound = 5 * variance / std::sqrt(static_cast<double>(frame.size()));
  using Shift = std::array<int, 2>;
  for (const Shift& shift : {Shift{1, 0}, Shift{2, 0}, Shift{3, 0}, Shift{0, 1}, Shift{1, 1},
                             Shift{0, 2}, Shift{7, 5}}) {
    const int du = shift[0], dv = shift[1];
    CAPTURE(du);
    CAPTURE(dv);
    CHECK(std::abs(mean_product(frame, frame, du, dv)) < bound);
    CHECK(std::abs(mean_product(frame, next, du, dv)) < bound);
  }
  CHECK(std::abs(mean_product(frame, next, 0, 0)) < bound);
}

TEST_CASE("no place of the picture shows the same noise again") {
  // The mean over frames of one pixel must fall with their number, also for a pixel that never
  // changes.
  constexpr int kFrames = 64;
  Renderer renderer(reference::pinhole(kWidth, 90, 1000), {.noise_sigma = 5});
  GreyImage image;
  std::vector<double> sums(static_cast<std::size_t>(kWidth) * 90, 0.0);
  for (std::uint64_t seed = 0; seed < kFrames; ++seed) {
    renderer.render({}, seed, image);
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += image.pixels[i] - 120.0;
  }
  double squares = 0;
  for (const double sum : sums) squares += (sum / kFrames) * (sum / kFrames);
  const double expected = (25 + 1.0 / 12) / kFrames;
  CHECK(squares / static_cast<double>(sums.size()) == doctest::Approx(expected).epsilon(0.03));
}

TEST_CASE("noise saturates at black and white instead of wrapping") {
  Renderer bright(reference::pinhole(640, 100, 1000), {.floor = 254, .noise_sigma = 60});
  Renderer dark(reference::pinhole(640, 100, 1000), {.floor = 1, .noise_sigma = 60});
  GreyImage image;
  bright.render({}, 3, image);
  const auto at = [&](int grey) {
    const auto found =
        std::count(image.pixels.begin(), image.pixels.end(), static_cast<std::uint8_t>(grey));
    return static_cast<double>(found) / static_cast<double>(image.pixels.size());
  };
  CHECK(at(255) > 0.45);
  CHECK(at(0) < 0.001);
  dark.render({}, 3, image);
  CHECK(at(0) > 0.45);
  CHECK(at(255) < 0.001);
}

TEST_CASE("the same seed gives the same picture, another seed another one") {
  const CameraModel camera = reference::pinhole(320, 200, 300);
  const Imaging imaging = {.blur_px = 0.7, .noise_sigma = 3};
  SceneMarker marker;
  marker.pose = {{0, 0, 0.5}, reference::facing()};
  GreyImage first, second, third;
  Renderer renderer(camera, imaging);
  renderer.render({{}, {marker}, {}}, 8, first);
  renderer.render({{}, {marker}, {}}, 9, second);
  Renderer(camera, imaging).render({{}, {marker}, {}}, 8, third);
  CHECK(first.pixels == third.pixels);
  CHECK(first.pixels != second.pixels);
}
