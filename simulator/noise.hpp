#pragma once

#include <cstdint>
#include <vector>

#include "simulator/response.hpp"

namespace roundel {

// Gaussian sensor noise from a large shuffled table: every row of every frame starts at another
// random place of it, so one pass of additions makes a noisy frame.
class NoiseTable {
 public:
  // sigma in grey levels, [0, kMaxSigma]; rows are at most max_width pixels wide.
  NoiseTable(double sigma, int max_width);

  // out = grey + noise, rounded to 8 bits; grey in Response's fixed point.
  void apply(const std::int16_t* grey, std::uint8_t* out, int width, std::uint64_t row_seed) const;

  static constexpr double kMaxSigma = 60;

 private:
  static constexpr std::uint32_t kSize = 1U << 20;
  std::vector<std::int16_t> values_;  // fixed point; the first row's worth repeats at the end
};

}  // namespace roundel
