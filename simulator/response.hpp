#pragma once

#include <cstdint>
#include <vector>

namespace roundel {

// The sensor's response curve, between linear light and grey levels, both in [0, 255].
class Response {
 public:
  // gamma 1 is linear; with srgb the piecewise curve of IEC 61966-2-1 is used instead.
  Response(double gamma, bool srgb);

  bool linear() const { return linear_; }
  double light_of_grey(double grey) const;
  double grey_of_light(double light) const;

  // Light to grey in fixed point (kFixedOne a grey level), clipped to [0, 255] grey levels.
  void encode(const float* light, std::int16_t* grey, int count) const;

  static constexpr int kFixedBits = 6;
  static constexpr int kFixedOne = 1 << kFixedBits;

 private:
  double gamma_;
  bool srgb_;
  bool linear_;
  std::vector<float> table_;  // grey by the square root of light, which opens up the dark end
};

}  // namespace roundel
