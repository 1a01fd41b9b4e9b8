#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace roundel {

// Durations in microseconds, counted in buckets whose width is 1/32 of their value, from 1 us to
// hours. Fixed size, no allocation.
class LatencyHistogram {
 public:
  void add(std::int64_t duration_us);  // negative ones count as 0
  void clear();

  std::int64_t count() const { return count_; }
  std::int64_t max_us() const { return max_us_; }
  // The smallest duration, to within a bucket, that a share of all does not exceed; 0 if empty.
  // share in (0, 1].
  double percentile_us(double share) const;

 private:
  static constexpr int kSubBits = 5;
  static constexpr int kMaxBits = 36;  // 19 hours; longer ones share the last bucket
  static constexpr std::size_t kBuckets = std::size_t{kMaxBits - kSubBits + 1} << kSubBits;

  static std::size_t bucket_of(std::uint64_t duration_us);
  static double middle_of(std::size_t bucket);

  std::array<std::uint32_t, kBuckets> buckets_{};
  std::int64_t count_ = 0;
  std::int64_t max_us_ = 0;
};

}  // namespace roundel
