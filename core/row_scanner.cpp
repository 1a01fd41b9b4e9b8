#include "core/row_scanner.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <type_traits>

#include "core/simd.hpp"

namespace roundel {

namespace {

constexpr int kBlock = 16;  // pixels

// Bounds of the run pattern across a marker's centre disc, in shares of the bright run. On a line
// through the middle of a marker the dark runs are 0.33 to 0.95 of it; near the centre disc's rim,
// or where the line clips a tooth, they are longer or shorter. The region tests decide; this only
// keeps them from being made for everything.
constexpr double kMinDark = 0.12, kMaxDark = 3.5;
constexpr double kMaxDarkImbalance = 6.0;
constexpr int kPixelSlack = 3;

}  // namespace

bool is_marker_pattern(int left, int bright, int right) {
  if (bright < 2) return false;
  const auto [shorter, longer] = std::minmax(left, right);
  return shorter >= kMinDark * bright && longer <= kMaxDark * bright + kPixelSlack &&
         longer <= kMaxDarkImbalance * shorter + kPixelSlack;
}

double estimate_noise(const LumaView& frame) {
  std::array<int, 256> histogram{};
  int count = 0;
  const int step_u = std::max(3, frame.width / 64), step_v = std::max(3, frame.height / 36);
  for (int v = step_v / 2; v < frame.height; v += step_v) {
    for (int u = step_u / 2; u + 1 < frame.width; u += step_u) {
      const int difference = std::abs(int(frame.at(u, v)) - int(frame.at(u + 1, v)));
      ++histogram[static_cast<std::size_t>(difference)];
      ++count;
    }
  }
  // Median of |difference|, interpolated within its grey level.
  int below = 0;
  for (int level = 0; level < 256; ++level) {
    const int here = histogram[static_cast<std::size_t>(level)];
    if (2 * (below + here) >= count) {
      const double within = here > 0 ? (0.5 * count - below) / here : 0;
      const double median = std::max(0.0, level - 0.5 + within);
      return median / 0.954;  // of |N(0, 2 sigma^2)|
    }
    below += here;
  }
  return 0;
}

namespace {

// Averages of 2 x 2 pixels; `count` of them, each with a neighbour to its right.
template <typename Stride>
ROUNDEL_INLINE void average(const std::uint8_t* upper, const std::uint8_t* lower, Stride stride,
                            int count, std::uint8_t* out) {
  // Means of two that round up: what vector units have an instruction for.
  const auto mean = [](unsigned a, unsigned b) { return (a + b + 1) >> 1; };
  for (int i = 0; i < count; ++i) {
    const unsigned here = mean(upper[i * stride], lower[i * stride]);
    const unsigned next = mean(upper[(i + 1) * stride], lower[(i + 1) * stride]);
    out[i] = static_cast<std::uint8_t>(mean(here, next));
  }
}

// Least and greatest level of every block.
ROUNDEL_INLINE void bound_blocks(const std::uint8_t* line, std::size_t blocks, std::uint8_t* low,
                                 std::uint8_t* high) {
  using simd::Byte16;
  for (std::size_t b = 0; b < blocks; ++b) {
    Byte16 least, greatest;
    __builtin_memcpy(&least, line + b * kBlock, sizeof least);
    greatest = least;
    const auto fold = [&](const Byte16& l, const Byte16& g) {
      least = l < least ? l : least;
      greatest = g > greatest ? g : greatest;
    };
    fold(
        __builtin_shufflevector(least, least, 8, 9, 10, 11, 12, 13, 14, 15, 0, 1, 2, 3, 4, 5, 6, 7),
        __builtin_shufflevector(greatest, greatest, 8, 9, 10, 11, 12, 13, 14, 15, 0, 1, 2, 3, 4, 5,
                                6, 7));
    fold(
        __builtin_shufflevector(least, least, 4, 5, 6, 7, 0, 1, 2, 3, 12, 13, 14, 15, 8, 9, 10, 11),
        __builtin_shufflevector(greatest, greatest, 4, 5, 6, 7, 0, 1, 2, 3, 12, 13, 14, 15, 8, 9,
                                10, 11));
    fold(
        __builtin_shufflevector(least, least, 2, 3, 0, 1, 6, 7, 4, 5, 10, 11, 8, 9, 14, 15, 12, 13),
        __builtin_shufflevector(greatest, greatest, 2, 3, 0, 1, 6, 7, 4, 5, 10, 11, 8, 9, 14, 15,
                                12, 13));
    low[b] = std::min(least[0], least[1]);
    high[b] = std::max(greatest[0], greatest[1]);
  }
}

// Bit i: pixel i of a block is darker than the threshold.
ROUNDEL_INLINE std::uint32_t dark_bits(const std::uint8_t* block, int threshold) {
  using simd::Byte16;
  Byte16 levels;
  __builtin_memcpy(&levels, block, sizeof levels);
  const Byte16 limit = Byte16{} + static_cast<std::uint8_t>(threshold);
  const auto darker = (levels < limit) & 1;
  std::array<std::uint64_t, 2> halves;
  __builtin_memcpy(halves.data(), &darker, sizeof darker);
  // Gathers the lowest bit of each byte in the uppermost byte.
  constexpr std::uint64_t kGather = 0x0102040810204080;
  return static_cast<std::uint32_t>((halves[0] * kGather) >> 56U) |
         static_cast<std::uint32_t>((halves[1] * kGather) >> 56U) << 8U;
}

// What is worth compiling for wider vectors as well; the results are the same.
struct LineKernels {
  void (*average)(const std::uint8_t* upper, const std::uint8_t* lower, int count,
                  std::uint8_t* out);
  void (*bound)(const std::uint8_t* line, std::size_t blocks, std::uint8_t* low,
                std::uint8_t* high);
};

#define ROUNDEL_LINE_KERNELS(suffix, attribute)                                                    \
  attribute void average_##suffix(const std::uint8_t* upper, const std::uint8_t* lower, int count, \
                                  std::uint8_t* out) {                                             \
    average(upper, lower, std::integral_constant<std::ptrdiff_t, 1>{}, count, out);                \
  }                                                                                                \
  attribute void bound_##suffix(const std::uint8_t* line, std::size_t blocks, std::uint8_t* low,   \
                                std::uint8_t* high) {                                              \
    bound_blocks(line, blocks, low, high);                                                         \
  }

ROUNDEL_LINE_KERNELS(baseline, )
#if defined(__x86_64__)
ROUNDEL_LINE_KERNELS(avx2, __attribute__((target("avx2"))))
#endif

const LineKernels& line_kernels() {
  static const LineKernels best = [] {
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2")) return LineKernels{average_avx2, bound_avx2};
#endif
    return LineKernels{average_baseline, bound_baseline};
  }();
  return best;
}

}  // namespace

void RowScanner::smooth(const LumaView& frame, int v, int u0, int u1) {
  const int count = u1 - u0 + 1;
  const int blocks = (count + kBlock - 1) / kBlock;
  line_.resize(static_cast<std::size_t>(blocks) * kBlock);
  std::uint8_t* out = line_.data();
  const std::uint8_t* upper = frame.row(v) + u0 * frame.pixel_stride;
  const std::uint8_t* lower = frame.row(v + 1) + u0 * frame.pixel_stride;
  if (frame.pixel_stride == 1) {
    line_kernels().average(upper, lower, count - 1, out);
  } else if (frame.pixel_stride == 2) {
    average(upper, lower, std::integral_constant<std::ptrdiff_t, 2>{}, count - 1, out);
  } else {
    average(upper, lower, frame.pixel_stride, count - 1, out);
  }
  // The last pixel has no right neighbour; the rest only fills the last block.
  const std::uint8_t last = count > 1 ? out[count - 2] : *upper;
  std::fill(line_.begin() + (count - 1), line_.end(), last);
}

void RowScanner::find_runs(int contrast) {
  const std::size_t blocks = line_.size() / kBlock;
  block_min_.resize(blocks + 2);
  block_max_.resize(blocks + 2);
  line_kernels().bound(line_.data(), blocks, block_min_.data() + 1, block_max_.data() + 1);
  // A guard on both sides, so that every block has two neighbours.
  block_min_.front() = block_min_[1];
  block_max_.front() = block_max_[1];
  block_min_.back() = block_min_[blocks];
  block_max_.back() = block_max_[blocks];

  run_ends_.clear();
  int threshold = -1;  // none yet
  bool dark = false;
  first_run_dark_ = false;
  for (std::size_t b = 0; b < blocks; ++b) {
    const int here_low = block_min_[b + 1], here_high = block_max_[b + 1];
    const int low = std::min({block_min_[b], block_min_[b + 1], block_min_[b + 2]});
    const int high = std::max({block_max_[b], block_max_[b + 1], block_max_[b + 2]});
    const bool contrasted = high - low >= contrast;
    if (contrasted) threshold = (low + high + 1) / 2;
    if (threshold < 0) continue;
    const int start = static_cast<int>(b) * kBlock;
    if (!contrasted || here_low >= threshold || here_high < threshold) {
      const bool is_dark = (here_low + here_high) / 2 < threshold;
      if (is_dark != dark) {
        if (start > 0) run_ends_.push_back(start);
        dark = is_dark;
      }
    } else {
      const std::uint32_t bits = dark_bits(line_.data() + start, threshold);
      // A set bit: the pixel's colour is not that of the pixel before.
      std::uint32_t changes = bits ^ ((bits << 1U) | (dark ? 1U : 0U));
      changes &= 0xFFFFU;
      for (; changes != 0; changes &= changes - 1) {
        const int u = start + std::countr_zero(changes);
        if (u > 0) run_ends_.push_back(u);
      }
      dark = ((bits >> (kBlock - 1)) & 1U) != 0;
      if (start == 0) first_run_dark_ = (bits & 1U) != 0;
      continue;
    }
    if (start == 0) first_run_dark_ = dark;
  }
  run_ends_.push_back(static_cast<std::int32_t>(line_.size()));
}

std::span<const Seed> RowScanner::scan(const LumaView& frame, int v, int u0, int u1, int contrast,
                                       int max_extent) {
  seeds_.clear();
  if (u1 - u0 < 8) return seeds_;
  smooth(frame, v, u0, u1);
  find_runs(contrast);
  const int last_end = u1 - u0 + 1;
  // run i covers run_ends_[i - 1] ... run_ends_[i] - 1; bright ones with a run on both sides.
  for (std::size_t i = first_run_dark_ ? 1 : 2; i + 1 < run_ends_.size(); i += 2) {
    const int left_start = i >= 2 ? run_ends_[i - 2] : 0;
    const int bright_start = run_ends_[i - 1], bright_end = run_ends_[i];
    const int right_end = std::min<int>(run_ends_[i + 1], last_end);
    const int left = bright_start - left_start, right = right_end - bright_end;
    if (right_end - left_start > max_extent) continue;
    if (!is_marker_pattern(left, bright_end - bright_start, right)) continue;
    const auto level = [&](int start, int end) {
      return line_[static_cast<std::size_t>((start + end) / 2)];
    };
    const int dark_level = (level(left_start, bright_start) + level(bright_end, right_end)) / 2;
    const int bright_level = level(bright_start, bright_end);
    if (bright_level - dark_level < contrast) continue;
    Seed seed;
    seed.v = v;
    seed.u = u0 + (left_start + bright_start) / 2;
    seed.bright_u = u0 + (bright_start + bright_end) / 2;
    seed.threshold = (dark_level + bright_level + 1) / 2;
    seed.extent = right_end - left_start;
    seeds_.push_back(seed);
  }
  return seeds_;
}

}  // namespace roundel
