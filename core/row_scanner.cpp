#include "core/row_scanner.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "core/byte_bits.hpp"
#include "core/line_kernels.hpp"

namespace roundel {

namespace {

constexpr int kBlock = LineKernels::kBlock;
constexpr std::size_t kBlocksAtOnce = LineKernels::kBlocksAtOnce;

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
  // Few places, as each is mostly new to the cache, with some pixels of each: the median of 600
  // differences is good to 5 %.
  constexpr int kColumns = 12, kRows = 18, kPairs = 3, kPairSpacing = 3, kReach = 8;
  std::array<int, 256> histogram{};
  int count = 0;
  const int step_u = std::max(kReach, frame.width / kColumns);
  const int step_v = std::max(3, frame.height / kRows);
  for (int v = step_v / 2; v < frame.height; v += step_v) {
    for (int u = step_u / 2; u + kReach <= frame.width; u += step_u) {
      for (int i = u; i < u + kPairs * kPairSpacing; i += kPairSpacing) {
        const int difference = std::abs(int(frame.at(i, v)) - int(frame.at(i + 1, v)));
        ++histogram[static_cast<std::size_t>(difference)];
      }
      count += kPairs;
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

// Bit i: flag i of 64 is set.
std::uint64_t flag_bits(const std::uint8_t* flags) {
  return ~bits_of_64_below(flags, 1);
}

}  // namespace

void RowScanner::start(const LumaView& frame, const Box& area, int spacing, int contrast,
                       int max_extent) {
  frame_ = frame;
  u0_ = std::max(0, area.u0);
  u1_ = std::min(frame.width - 1, area.u1);
  v_ = std::max(0, area.v0);
  last_v_ = std::min(frame.height - 2, area.v1);
  spacing_ = spacing;
  contrast_ = contrast;
  max_extent_ = max_extent;
  seeds_.clear();
  constexpr int kNarrowest = 9;
  const int width = u1_ - u0_ + 1;
  if (width < kNarrowest) last_v_ = -1;
  if (v_ > last_v_) return;
  blocks_ = static_cast<std::size_t>((width + kBlock - 1) / kBlock);
  const std::size_t padded = (blocks_ + kBlocksAtOnce - 1) / kBlocksAtOnce * kBlocksAtOnce;
  for (Line& line : lines_) {
    line.levels.resize(padded * kBlock);
    line.block_min.resize(padded + 2);
    line.block_max.resize(padded + 2);
  }
  for (auto* bytes : {&threshold_, &middle_, &contrasted_, &crossing_}) bytes->resize(padded);
  prepare(lines_[prepared_], v_);
}

bool RowScanner::next() {
  if (v_ > last_v_) return false;
  const Line& line = lines_[prepared_];
  prepared_ = 1 - prepared_;
  v_ += spacing_;
  if (v_ <= last_v_) prepare(lines_[prepared_], v_);
  if (v_ + spacing_ <= last_v_) prefetch(v_ + spacing_);
  find_runs(line);
  find_seeds(line);
  return true;
}

// The camera's driver has just written the picture, mostly not into this processor's cache.
void RowScanner::prefetch(int v) const {
  constexpr std::ptrdiff_t kCacheLine = 64;
  const std::ptrdiff_t bytes = (u1_ - u0_ + 1) * frame_.pixel_stride;
  for (const int row : {v, v + 1}) {
    const std::uint8_t* from = frame_.row(row) + u0_ * frame_.pixel_stride;
    for (std::ptrdiff_t i = 0; i < bytes; i += kCacheLine) __builtin_prefetch(from + i);
  }
}

void RowScanner::prepare(Line& line, int v) {
  const LineKernels& kernels = line_kernels();
  line.v = v;
  const int count = u1_ - u0_ + 1;
  std::uint8_t* out = line.levels.data();
  const std::uint8_t* upper = frame_.row(v) + u0_ * frame_.pixel_stride;
  const std::uint8_t* lower = frame_.row(v + 1) + u0_ * frame_.pixel_stride;
  kernels.average(upper, lower, frame_.pixel_stride, count - 1, out);
  // The last pixel has no right neighbour; the rest only fills the last blocks.
  std::fill(line.levels.begin() + (count - 1), line.levels.end(), out[count - 2]);

  const std::size_t padded = line.levels.size() / kBlock;
  kernels.bound(out, padded, line.block_min.data() + 1, line.block_max.data() + 1);
  // A guard on both sides, so that every block has two neighbours.
  for (auto* bounds : {&line.block_min, &line.block_max}) {
    bounds->front() = (*bounds)[1];
    bounds->back() = (*bounds)[padded];
  }
}

void RowScanner::find_runs(const Line& line) {
  line_kernels().judge(line.block_min.data(), line.block_max.data(), threshold_.size(),
                       static_cast<std::uint8_t>(contrast_),
                       {threshold_.data(), middle_.data(), contrasted_.data(), crossing_.data()});

  run_ends_.clear();
  first_run_dark_ = false;
  bool dark = false, known = false;  // a threshold, from some block on
  std::uint8_t threshold = 0;
  for (std::size_t word = 0; word < blocks_; word += 64) {
    const std::size_t rest = blocks_ - word;
    const std::uint64_t all = rest >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << rest) - 1;
    const std::uint64_t contrasted = flag_bits(contrasted_.data() + word) & all;
    std::uint64_t left = all;  // blocks still to be looked at
    if (!known) {
      if (contrasted == 0) continue;
      left &= ~std::uint64_t{0} << std::countr_zero(contrasted);
      known = true;
    }
    while (left != 0) {
      const auto first = static_cast<unsigned>(std::countr_zero(left));
      if (((contrasted >> first) & 1U) == 0) {
        // Up to the next contrast the last threshold holds; a block has one colour.
        const std::uint64_t here = left & ~contrasted;
        const std::uint64_t beyond = left & contrasted;
        const std::uint64_t stretch = beyond == 0 ? here : here & ((beyond & (~beyond + 1)) - 1);
        const std::uint64_t bits = bits_of_64_below(middle_.data() + word, threshold);
        std::uint64_t before = bits << 1U;
        before = (before & ~(std::uint64_t{1} << first)) | std::uint64_t{dark ? 1U : 0U} << first;
        for (std::uint64_t changes = (bits ^ before) & stretch; changes != 0;
             changes &= changes - 1) {
          run_ends_.push_back(static_cast<std::int32_t>(word + std::countr_zero(changes)) * kBlock);
        }
        dark = ((bits >> (63 - std::countl_zero(stretch))) & 1U) != 0;
        left &= ~stretch;
        continue;
      }
      const std::size_t block = word + first;
      const int start = static_cast<int>(block) * kBlock;
      threshold = threshold_[block];
      if (crossing_[block] != 0) {
        const std::uint32_t bits = bits_below(line.levels.data() + start, threshold);
        // A set bit: the pixel's colour is not that of the pixel before.
        std::uint32_t changes = bits ^ ((bits << 1U) | (dark ? 1U : 0U));
        if (start == 0) {
          first_run_dark_ = (bits & 1U) != 0;
          changes &= ~1U;
        }
        for (changes &= 0xFFFFU; changes != 0; changes &= changes - 1) {
          run_ends_.push_back(start + std::countr_zero(changes));
        }
        dark = ((bits >> (kBlock - 1)) & 1U) != 0;
      } else {
        const bool is_dark = middle_[block] < threshold;
        if (start == 0) {
          first_run_dark_ = is_dark;
        } else if (is_dark != dark) {
          run_ends_.push_back(start);
        }
        dark = is_dark;
      }
      left &= left - 1;
    }
  }
  run_ends_.push_back(static_cast<std::int32_t>(blocks_ * kBlock));
}

void RowScanner::find_seeds(const Line& line) {
  seeds_.clear();
  const int last_end = u1_ - u0_ + 1;
  // run i covers run_ends_[i - 1] ... run_ends_[i] - 1; bright ones with a run on both sides.
  for (std::size_t i = first_run_dark_ ? 1 : 2; i + 1 < run_ends_.size(); i += 2) {
    const int left_start = i >= 2 ? run_ends_[i - 2] : 0;
    const int bright_start = run_ends_[i - 1], bright_end = run_ends_[i];
    const int right_end = std::min<int>(run_ends_[i + 1], last_end);
    const int left = bright_start - left_start, right = right_end - bright_end;
    if (right_end - left_start > max_extent_) continue;
    if (!is_marker_pattern(left, bright_end - bright_start, right)) continue;
    const auto level = [&](int start, int end) {
      return line.levels[static_cast<std::size_t>((start + end) / 2)];
    };
    const int dark_level = (level(left_start, bright_start) + level(bright_end, right_end)) / 2;
    const int bright_level = level(bright_start, bright_end);
    if (bright_level - dark_level < contrast_) continue;
    Seed seed;
    seed.v = line.v;
    seed.u = u0_ + (left_start + bright_start) / 2;
    seed.bright_u = u0_ + (bright_start + bright_end) / 2;
    seed.threshold = (dark_level + bright_level + 1) / 2;
    seed.extent = right_end - left_start;
    seeds_.push_back(seed);
  }
}

}  // namespace roundel
