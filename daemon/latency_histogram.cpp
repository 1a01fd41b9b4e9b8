#include "daemon/latency_histogram.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace roundel {

// Durations below 2^kSubBits have a bucket each; above, every octave has 2^kSubBits.
std::size_t LatencyHistogram::bucket_of(std::uint64_t duration_us) {
  duration_us = std::min<std::uint64_t>(duration_us, (std::uint64_t{1} << kMaxBits) - 1);
  const auto bits = static_cast<int>(std::bit_width(duration_us));
  if (bits <= kSubBits) return static_cast<std::size_t>(duration_us);
  const int shift = bits - kSubBits - 1;
  return (static_cast<std::size_t>(shift) << kSubBits) +
         static_cast<std::size_t>(duration_us >> shift);
}

double LatencyHistogram::middle_of(std::size_t bucket) {
  if (bucket < (std::size_t{1} << kSubBits)) return static_cast<double>(bucket);
  const std::size_t shift = (bucket >> kSubBits) - 1;
  const std::size_t first = (bucket - (shift << kSubBits)) << shift;
  return static_cast<double>(first) + 0.5 * static_cast<double>((std::size_t{1} << shift) - 1);
}

void LatencyHistogram::add(std::int64_t duration_us) {
  duration_us = std::max<std::int64_t>(0, duration_us);
  ++buckets_[bucket_of(static_cast<std::uint64_t>(duration_us))];
  ++count_;
  max_us_ = std::max(max_us_, duration_us);
}

void LatencyHistogram::clear() {
  *this = LatencyHistogram();
}

double LatencyHistogram::percentile_us(double share) const {
  if (count_ == 0) return 0;
  const auto wanted = static_cast<std::int64_t>(std::ceil(share * static_cast<double>(count_)));
  std::int64_t seen = 0;
  for (std::size_t bucket = 0; bucket < buckets_.size(); ++bucket) {
    seen += buckets_[bucket];
    if (seen >= wanted) return std::min(middle_of(bucket), static_cast<double>(max_us_));
  }
  return static_cast<double>(max_us_);
}

}  // namespace roundel
