#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

namespace roundel::test {

// Random numbers for property tests that are the same on every platform (the standard library's
// distributions are not). SplitMix64.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t next() {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15U);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
    return z ^ (z >> 31);
  }
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(next() >> 11) * 0x1p-53;
  }
  int integer(int low, int high) {  // both included
    return low + static_cast<int>(next() % static_cast<std::uint64_t>(high - low + 1));
  }
  double gaussian() {
    return std::sqrt(-2 * std::log(uniform(0x1p-53, 1))) *
           std::cos(uniform(0, 2 * std::numbers::pi));
  }

 private:
  std::uint64_t state_;
};

}  // namespace roundel::test
