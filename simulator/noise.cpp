#include "simulator/noise.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

#include "simulator/random.hpp"

namespace roundel {

namespace {

// Where the normal distribution has the share p of its weight below, p in (0, 1/2): Halley's method
// on erfc, from a place near by. Exact to the last digits that a fixed-point table can hold.
double lower_quantile(double p, double x) {
  constexpr double kRootTwoPi = 2.506628274631000502;
  for (int step = 0; step < 60; ++step) {
    const double share = 0.5 * std::erfc(-x / std::numbers::sqrt2);
    const double newton = (share - p) * kRootTwoPi * std::exp(0.5 * x * x);
    const double change = newton / (1 + 0.5 * newton * x);
    x -= change;
    if (std::abs(change) < 1e-7) break;  // cubic convergence: the next one would be below 1e-18
  }
  return x;
}

}  // namespace

NoiseTable::NoiseTable(double sigma, int max_width) {
  if (!(sigma >= 0 && sigma <= kMaxSigma)) {
    throw std::invalid_argument("noise_sigma is " + std::to_string(sigma) +
                                " grey levels; it must lie between 0 and 60");
  }
  if (sigma == 0) return;
  // The quantiles themselves, in random order: mean and sigma are exact, not just expected.
  values_.resize(kSize + static_cast<std::size_t>(max_width));
  double quantile = -5;
  for (std::uint32_t i = 0; i < kSize / 2; ++i) {
    quantile = lower_quantile((i + 0.5) / kSize, quantile);
    const double value = sigma * quantile * Response::kFixedOne;
    // Rounded down, half a unit too low on average: apply() rounds halves up, which is as much too
    // high.
    const double limit = 255.0 * Response::kFixedOne - 1;
    values_[i] = static_cast<std::int16_t>(std::floor(std::max(value, -limit)));
    values_[kSize - 1 - i] = static_cast<std::int16_t>(std::floor(std::min(-value, limit)));
  }
  Random random(0x6e6f697365U);
  for (std::uint32_t i = kSize - 1; i > 0; --i) std::swap(values_[i], values_[random.below(i + 1)]);
  std::copy_n(values_.begin(), max_width, values_.begin() + kSize);
}

void NoiseTable::apply(const std::int16_t* grey, std::uint8_t* out, int width,
                       std::uint64_t row_seed) const {
  constexpr std::int16_t kHalf = Response::kFixedOne / 2;
  constexpr int kShift = Response::kFixedBits;
  if (values_.empty()) {
    for (int u = 0; u < width; ++u) {
      out[u] = static_cast<std::uint8_t>(static_cast<std::int16_t>(grey[u] + kHalf) >> kShift);
    }
    return;
  }
  const std::int16_t* noise = values_.data() + (row_seed & (kSize - 1));
  for (int u = 0; u < width; ++u) {
    // 16 bits hold all of it: both are below 2^14.
    const auto sum = static_cast<std::int16_t>(grey[u] + noise[u] + kHalf);
    const auto level = static_cast<std::int16_t>(sum >> kShift);
    const std::int16_t low = level < 0 ? std::int16_t{0} : level;
    out[u] = static_cast<std::uint8_t>(low > 255 ? std::int16_t{255} : low);
  }
}

}  // namespace roundel
