#include "core/response_curve.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>

namespace roundel {

namespace {
constexpr double kMinGamma = 0.2, kMaxGamma = 5;
}  // namespace

void ResponseCurve::fill_slopes() {
  for (std::size_t k = 0; k < 256; ++k) {
    const std::size_t below = k > 0 ? k - 1 : 0, above = k < 255 ? k + 1 : 255;
    slope_[k] = static_cast<float>(above - below) / (light_[above] - light_[below]);
  }
}

ResponseCurve ResponseCurve::linear() {
  ResponseCurve curve = power(1);
  curve.linear_ = true;
  return curve;
}

ResponseCurve ResponseCurve::srgb() {
  ResponseCurve curve;
  for (std::size_t k = 0; k < 256; ++k) {
    const double x = static_cast<double>(k) / 255;
    curve.light_[k] =
        static_cast<float>(255 * (x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4)));
  }
  curve.fill_slopes();
  return curve;
}

ResponseCurve ResponseCurve::power(double gamma) {
  if (!(gamma >= kMinGamma && gamma <= kMaxGamma)) {
    throw std::invalid_argument("the response curve's gamma must be 0.2 to 5");
  }
  ResponseCurve curve;
  for (std::size_t k = 0; k < 256; ++k) {
    curve.light_[k] = static_cast<float>(255 * std::pow(static_cast<double>(k) / 255, gamma));
  }
  curve.fill_slopes();
  return curve;
}

ResponseCurve ResponseCurve::like_srgb(double exponent) {
  const double offset = 0.055 * (exponent - 1) / 1.4;
  const double least = std::pow(offset > 0 ? offset / (1 + offset) : 0.0, exponent);
  ResponseCurve curve;
  for (std::size_t k = 0; k < 256; ++k) {
    const double x = std::max(0.0, (static_cast<double>(k) / 255 + offset) / (1 + offset));
    curve.light_[k] = static_cast<float>(255 * (std::pow(x, exponent) - least) / (1 - least)) +
                      static_cast<float>(k) * 1e-3F;  // strictly rising
  }
  curve.fill_slopes();
  return curve;
}

std::optional<ResponseCurve> ResponseCurve::named(std::string_view name) {
  if (name == "linear") return linear();
  if (name == "srgb") return srgb();
  double gamma = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), gamma);
  const bool whole = error == std::errc() && end == name.data() + name.size();
  if (!whole || !(gamma >= kMinGamma && gamma <= kMaxGamma)) return std::nullopt;
  return power(gamma);
}

void ResponseCurve::undo(const std::uint8_t* grey, std::size_t count, float* light,
                         float* slopes) const {
  if (linear_) {                        // without look-ups: mostly no curve is known
    constexpr std::size_t kChunk = 16;  // what compilers make a few instructions of
    std::size_t i = 0;
    for (; i + kChunk <= count; i += kChunk) {
      std::array<std::uint8_t, kChunk> levels{};
      std::copy_n(grey + i, kChunk, levels.begin());
      for (std::size_t k = 0; k < kChunk; ++k) light[i + k] = levels[k];
      for (std::size_t k = 0; k < kChunk; ++k) slopes[i + k] = 1;
    }
    for (; i < count; ++i) {
      light[i] = grey[i];
      slopes[i] = 1;
    }
    return;
  }
  for (std::size_t i = 0; i < count; ++i) {
    light[i] = light_[grey[i]];
    slopes[i] = slope_[grey[i]];
  }
}

double ResponseCurve::light(double grey) const {
  const double level = std::clamp(grey, 0.0, 255.0);
  const auto below = static_cast<std::size_t>(std::min(level, 254.0));
  const double part = level - static_cast<double>(below);
  return (1 - part) * static_cast<double>(light_[below]) +
         part * static_cast<double>(light_[below + 1]);
}

}  // namespace roundel
