#pragma once

#include <cstdint>

namespace roundel {

// A small generator whose sequence is the same on every platform (the standard library's
// distributions are not). SplitMix64: 64 bits of state, every seed is a good one.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t bits() {
    state_ += 0x9e3779b97f4a7c15U;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31);
  }

  // In [0, 1).
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }

  double uniform(double low, double high) { return low + (high - low) * uniform(); }

  // In [0, count); count > 0. The bias of 2^-32 is of no concern here.
  std::uint32_t below(std::uint32_t count) {
    return static_cast<std::uint32_t>(((bits() >> 32) * count) >> 32);
  }

 private:
  std::uint64_t state_;
};

// A seed for a purpose of its own ("stream") derived from a seed.
inline std::uint64_t derived_seed(std::uint64_t seed, std::uint64_t stream) {
  return Random(seed ^ (stream * 0xd1342543de82ef95U + 0x2545f4914f6cdd1dU)).bits();
}

}  // namespace roundel
