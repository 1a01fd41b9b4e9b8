#include "core/region.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <queue>
#include <vector>

#include "core/grey_image.hpp"
#include "core/line_kernels.hpp"
#include "core/row_scanner.hpp"
#include "tests/random.hpp"

using namespace roundel;  // NOLINT(google-build-using-namespace)
using roundel::test::Random;

namespace {

GreyImage blank(int width, int height, int level) {
  GreyImage image;
  image.resize(width, height);
  std::fill(image.pixels.begin(), image.pixels.end(), static_cast<std::uint8_t>(level));
  return image;
}

void set(GreyImage& image, int u, int v, int level) {
  image.at(u, v) = static_cast<std::uint8_t>(level);
}

void paint_ellipse(GreyImage& image, const Ellipse& e, int level) {
  for (int v = 0; v < image.height; ++v) {
    for (int u = 0; u < image.width; ++u) {
      const double x = (u - e.u) * std::cos(e.angle) + (v - e.v) * std::sin(e.angle);
      const double y = (v - e.v) * std::cos(e.angle) - (u - e.u) * std::sin(e.angle);
      if (x * x / (e.a * e.a) + y * y / (e.b * e.b) <= 1) set(image, u, v, level);
    }
  }
}

}  // namespace

TEST_CASE("a region has the pixels that a plain flood fill finds") {
  Random random(21);
  for (int round = 0; round < 200; ++round) {
    GreyImage image = blank(40, 30, 200);
    for (int i = 0; i < 600; ++i) set(image, random.integer(1, 38), random.integer(1, 28), 20);
    const int u = random.integer(1, 38), v = random.integer(1, 28);
    RegionFiller filler;
    const FillResult result = filler.fill(image.view(), u, v, 100, {});
    if (image.view().at(u, v) >= 100) {
      CHECK(result == FillResult::kNoSeed);
      continue;
    }
    REQUIRE(result == FillResult::kComplete);
    Moments expected;
    std::vector<bool> seen(image.pixels.size());
    std::queue<std::pair<int, int>> queue;
    queue.emplace(u, v);
    seen[static_cast<std::size_t>(v * 40 + u)] = true;
    while (!queue.empty()) {
      const auto [x, y] = queue.front();
      queue.pop();
      expected.add_run(x - u, x - u, y - v);
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          const auto index = static_cast<std::size_t>((y + dy) * 40 + x + dx);
          if (image.pixels[index] >= 100 || seen[index]) continue;
          seen[index] = true;
          queue.emplace(x + dx, y + dy);
        }
      }
    }
    const Moments& found = filler.region().dark;
    CHECK(found.n == expected.n);
    CHECK(found.su == expected.su);
    CHECK(found.sv == expected.sv);
    CHECK(found.suu == expected.suu);
    CHECK(found.suv == expected.suv);
    CHECK(found.svv == expected.svv);
  }
}

TEST_CASE("a region is the same in packed pictures, where luma and chroma take turns") {
  Random random(25);
  constexpr int kWidth = 200, kHeight = 40;  // more than a word of pixels, and not whole words
  for (int round = 0; round < 50; ++round) {
    GreyImage image = blank(kWidth, kHeight, 200);
    for (int i = 0; i < 4000; ++i) set(image, random.integer(1, 198), random.integer(1, 38), 20);
    std::vector<std::uint8_t> packed(2 * image.pixels.size());
    for (auto& byte : packed) byte = static_cast<std::uint8_t>(random.integer(0, 255));
    for (std::size_t i = 0; i < image.pixels.size(); ++i) packed[2 * i + 1] = image.pixels[i];
    const LumaView luma = uyvy_view(packed.data(), kWidth, kHeight, 2 * kWidth);
    RegionFiller one, other;
    const int u = random.integer(1, 198), v = random.integer(1, 38);
    const FillResult result = one.fill(image.view(), u, v, 100, {});
    REQUIRE(other.fill(luma, u, v, 100, {}) == result);
    if (result != FillResult::kComplete) continue;
    CHECK(other.region().dark.n == one.region().dark.n);
    CHECK(other.region().dark.suv == one.region().dark.suv);
    CHECK(other.region().filled.suu == one.region().filled.suu);
  }
}

TEST_CASE("a region that reaches the border or outgrows its limit is given up") {
  GreyImage image = blank(60, 60, 200);
  for (int u = 20; u < 40; ++u) set(image, u, 30, 10);
  RegionFiller filler;
  CHECK(filler.fill(image.view(), 25, 30, 100, {}) == FillResult::kComplete);
  CHECK(filler.region().box.u0 == 20);
  CHECK(filler.region().box.u1 == 39);
  CHECK(filler.fill(image.view(), 25, 30, 100, {19, 100}) == FillResult::kTooLarge);
  CHECK(filler.fill(image.view(), 25, 30, 100, {20, 1}) == FillResult::kComplete);
  for (int v = 0; v <= 30; ++v) set(image, 22, v, 10);
  CHECK(filler.fill(image.view(), 25, 30, 100, {}) == FillResult::kTouchesEdge);
}

TEST_CASE("what outgrows its limits is given up after a line of runs, not an area") {
  Random random(26);
  GreyImage image = blank(600, 600, 20);
  for (int i = 0; i < 110'000; ++i) set(image, random.integer(0, 599), random.integer(0, 599), 200);
  set(image, 300, 300, 20);
  constexpr int kLimit = 200;
  RegionFiller filler;
  REQUIRE(filler.fill(image.view(), 300, 300, 100, {kLimit, kLimit}) == FillResult::kTooLarge);
  int runs = 0;
  filler.for_each_run([&](const Run&) { ++runs; });
  CHECK(runs < 2 * kLimit);  // all around, as far as the limit: 1233
}

TEST_CASE("what lies inside the outline does not change its filled moments") {
  GreyImage plain = blank(80, 80, 200), patterned = plain;
  const Ellipse outline{40.3, 38.6, 25, 17, 0.5};
  paint_ellipse(plain, outline, 20);
  patterned = plain;
  paint_ellipse(patterned, {40.3, 38.6, 12, 8, 0.5}, 200);
  set(patterned, 25, 35, 200);
  RegionFiller one, other;
  REQUIRE(one.fill(plain.view(), 22, 30, 100, {}) == FillResult::kComplete);
  REQUIRE(other.fill(patterned.view(), 22, 30, 100, {}) == FillResult::kComplete);
  CHECK(one.region().filled.n == other.region().filled.n);
  CHECK(one.region().filled.suv == other.region().filled.suv);
  CHECK(other.region().dark.n < other.region().filled.n);
}

TEST_CASE("the moments of a drawn ellipse give the ellipse back, small and thin ones too") {
  Random random(22);
  double worst_axis = 0, worst_centre = 0;
  for (int i = 0; i < 300; ++i) {
    const double a = random.uniform(14, 40);
    const Ellipse truth{60 + random.uniform(-1, 1), 60 + random.uniform(-1, 1), a,
                        a * random.uniform(0.25, 1), random.uniform(-1.5, 1.5)};
    GreyImage image = blank(120, 120, 200);
    paint_ellipse(image, truth, 20);
    RegionFiller filler;
    REQUIRE(filler.fill(image.view(), 60, 60, 100, {}) == FillResult::kComplete);
    const auto found =
        moment_ellipse(filler.region().filled, filler.region().origin_u, filler.region().origin_v);
    REQUIRE(found.has_value());
    worst_axis = std::max({worst_axis, std::abs(found->a - truth.a), std::abs(found->b - truth.b)});
    worst_centre = std::max(worst_centre, std::hypot(found->u - truth.u, found->v - truth.v));
    if (truth.b < 0.8 * truth.a) {
      CHECK(std::abs(std::sin(found->angle - truth.angle)) < 0.05);
    }
  }
  CHECK(worst_axis < 0.35);  // an edge pixel is in or out: some tenths of a pixel for the smallest
  CHECK(worst_centre < 0.25);
}

TEST_CASE("points or lines of pixels are no ellipse") {
  Moments moments;
  CHECK_FALSE(moment_ellipse(moments, 0, 0).has_value());
  moments.add_run(0, 0, 0);
  CHECK_FALSE(moment_ellipse(moments, 0, 0).has_value());
}

TEST_CASE("a row across a marker's centre makes one seed between its dark runs") {
  GreyImage image = blank(200, 9, 120);
  for (int v = 0; v < 9; ++v) {
    for (int u = 60; u < 130; ++u) {
      const int r = std::abs(u - 95);
      set(image, u, v, r > 28 ? 215 : r > 12 ? 35 : 215);
    }
  }
  RowScanner scanner;
  scanner.start(image.view(), {0, 4, 199, 4}, 1, 20, 500);
  REQUIRE(scanner.next());
  int between = 0;
  for (const Seed& seed : scanner.seeds()) {
    if (std::abs(seed.bright_u - 95) > 2) continue;
    ++between;
    CHECK(image.view().at(seed.u, seed.v) == 35);
    CHECK(seed.threshold == doctest::Approx(125).epsilon(0.05));
    CHECK(seed.extent == doctest::Approx(57).epsilon(0.05));
  }
  CHECK(between == 1);
}

TEST_CASE("a slow gradient or noise below the contrast makes no seed") {
  GreyImage image = blank(400, 4, 0);
  Random random(23);
  for (int v = 0; v < 4; ++v) {
    for (int u = 0; u < 400; ++u) {
      set(image, u, v, static_cast<int>(40 + 0.45 * u + 2 * random.gaussian()));
    }
  }
  RowScanner scanner;
  scanner.start(image.view(), {0, 1, 399, 1}, 1, 25, 500);
  REQUIRE(scanner.next());
  CHECK(scanner.seeds().empty());
  CHECK_FALSE(scanner.next());
}

TEST_CASE("the noise estimate follows the noise, not the edges") {
  Random random(24);
  for (const double sigma : {2.0, 5.0, 10.0}) {
    GreyImage image = blank(640, 480, 0);
    for (int v = 0; v < 480; ++v) {
      for (int u = 0; u < 640; ++u) {
        const double level = (u / 20 + v / 20) % 2 ? 200 : 60;
        set(image, u, v, static_cast<int>(std::lround(level + sigma * random.gaussian())));
      }
    }
    CHECK(estimate_noise(image.view()) == doctest::Approx(sigma).epsilon(0.15));
  }
}

TEST_CASE(
    "averages are the same by any vector unit, and by plain counting, with pixels apart too") {
  Random random(78);
  for (const std::ptrdiff_t stride : {1, 2, 3}) {
    for (const int count : {5, 63, 64, 65, 200, 257}) {
      // Exactly the bytes that there are: the last pixel is the last byte.
      std::vector<std::uint8_t> upper(static_cast<std::size_t>(count * stride + 1));
      std::vector<std::uint8_t> lower(upper.size());
      for (auto* bytes : {&upper, &lower}) {
        for (auto& byte : *bytes) byte = static_cast<std::uint8_t>(random.integer(0, 255));
      }
      for (const VectorUnit unit :
           {VectorUnit::kBest, VectorUnit::kNextBest, VectorUnit::kBaseline}) {
        std::vector<std::uint8_t> line(static_cast<std::size_t>(count) + 1, 99);
        line_kernels(unit).average(upper.data(), lower.data(), stride, count, line.data());
        for (int i = 0; i < count; ++i) {
          const auto mean = [&](std::ptrdiff_t at) {
            const auto k = static_cast<std::size_t>(at);
            return (upper[k] + lower[k] + 1) / 2;
          };
          REQUIRE(line[static_cast<std::size_t>(i)] ==
                  (mean(i * stride) + mean((i + 1) * stride) + 1) / 2);
        }
        CHECK(line.back() == 99);
      }
    }
  }
}

TEST_CASE("what a row's blocks look like is the same by any vector unit, and by plain counting") {
  constexpr std::size_t kBlocks = 2 * LineKernels::kBlocksAtOnce;
  constexpr std::size_t kPixels = kBlocks * LineKernels::kBlock;
  Random random(77);
  const auto bytes = [&](std::size_t count) {
    std::vector<std::uint8_t> made(count);
    for (auto& byte : made) byte = static_cast<std::uint8_t>(random.integer(0, 255));
    return made;
  };
  const auto upper = bytes(kPixels + 1), lower = bytes(kPixels + 1);
  std::vector<std::vector<std::uint8_t>> results;
  for (const VectorUnit unit : {VectorUnit::kBest, VectorUnit::kNextBest, VectorUnit::kBaseline}) {
    const LineKernels& kernels = line_kernels(unit);
    std::vector<std::uint8_t> line(kPixels), low(kBlocks + 2), high(kBlocks + 2);
    kernels.average(upper.data(), lower.data(), 1, kPixels, line.data());
    // Calmer toward the end, so that blocks of all kinds occur.
    for (std::size_t i = 0; i < kPixels; ++i)
      line[i] = static_cast<std::uint8_t>(line[i] >> (i / 512));
    kernels.bound(line.data(), kBlocks, low.data() + 1, high.data() + 1);
    for (std::size_t b = 0; b < kBlocks; ++b) {
      const auto first = line.begin() + static_cast<std::ptrdiff_t>(b * LineKernels::kBlock);
      const auto [least, greatest] = std::minmax_element(first, first + LineKernels::kBlock);
      REQUIRE(low[b + 1] == *least);
      REQUIRE(high[b + 1] == *greatest);
    }
    std::vector<std::uint8_t> looks(4 * kBlocks);
    std::uint8_t* out = looks.data();
    kernels.judge(low.data(), high.data(), kBlocks, 20,
                  {out, out + kBlocks, out + 2 * kBlocks, out + 3 * kBlocks});
    for (std::size_t b = 0; b < kBlocks; ++b) {
      const int l = std::min({low[b], low[b + 1], low[b + 2]});
      const int h = std::max({high[b], high[b + 1], high[b + 2]});
      const int half = (l + h + 1) / 2;
      REQUIRE(looks[b] == half);
      REQUIRE(looks[kBlocks + b] == (low[b + 1] + high[b + 1]) / 2);
      REQUIRE(looks[2 * kBlocks + b] == (h - l >= 20 ? 255 : 0));
      REQUIRE(looks[3 * kBlocks + b] ==
              (h - l >= 20 && low[b + 1] < half && high[b + 1] >= half ? 255 : 0));
    }
    results.push_back(line);
    results.back().insert(results.back().end(), looks.begin(), looks.end());
  }
  CHECK(results[0] == results[2]);
  CHECK(results[1] == results[2]);
}
