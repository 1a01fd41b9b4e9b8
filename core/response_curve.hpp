#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace roundel {

// How a camera turns light into grey levels, as a table that undoes it. Edges are blurred in light,
// not in grey levels: taking one for the other makes dark areas shrink and distances wrong by some
// percent (METHOD.md section 9.5).
class ResponseCurve {
 public:
  // Grey levels proportional to the light.
  static ResponseCurve linear();
  // The curve of sRGB (IEC 61966-2-1), which most webcams and JPEG pictures come close to.
  static ResponseCurve srgb();
  // grey = 255 (light / 255)^(1 / gamma). Throws std::invalid_argument unless gamma is 0.2 to 5.
  static ResponseCurve power(double gamma);

  // Curves that lead from the linear one (exponent 1) to that of sRGB without its foot (2.4).
  static ResponseCurve like_srgb(double exponent);

  // "linear", "srgb" or a gamma like "2.2". Nothing for anything else.
  static std::optional<ResponseCurve> named(std::string_view name);

  // Light of a grey level, both 0 to 255.
  float light(std::uint8_t grey) const { return light_[grey]; }
  double light(double grey) const;

  // The light of many pixels, and slope() of each.
  void undo(const std::uint8_t* grey, std::size_t count, float* light, float* slopes) const;

  // Grey levels a unit of light around a grey level: noise of even grey levels is uneven in light.
  float slope(std::uint8_t grey) const { return slope_[grey]; }

 private:
  ResponseCurve() = default;
  void fill_slopes();

  std::array<float, 256> light_{}, slope_{};
  bool linear_ = false;
};

}  // namespace roundel
