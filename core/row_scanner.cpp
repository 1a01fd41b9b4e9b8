#include "core/row_scanner.hpp"

#include <algorithm>
#include <array>
#include <cmath>

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

void RowScanner::smooth(const LumaView& frame, int v, int u0, int u1) {
  const int count = u1 - u0 + 1;
  const int blocks = (count + kBlock - 1) / kBlock;
  line_.resize(static_cast<std::size_t>(blocks) * kBlock);
  std::uint8_t* out = line_.data();
  const auto average = [&](const auto* upper, const auto* lower, auto stride) {
    for (int i = 0; i + 1 < count; ++i) {
      out[i] = static_cast<std::uint8_t>((upper[i * stride] + upper[(i + 1) * stride] +
                                          lower[i * stride] + lower[(i + 1) * stride] + 2) >>
                                         2);
    }
  };
  const std::uint8_t* upper = frame.row(v) + u0 * frame.pixel_stride;
  const std::uint8_t* lower = frame.row(v + 1) + u0 * frame.pixel_stride;
  if (frame.pixel_stride == 1) {
    average(upper, lower, std::integral_constant<std::ptrdiff_t, 1>{});
  } else if (frame.pixel_stride == 2) {
    average(upper, lower, std::integral_constant<std::ptrdiff_t, 2>{});
  } else {
    average(upper, lower, frame.pixel_stride);
  }
  // The last pixel has no right neighbour; the rest only fills the last block.
  const std::uint8_t last = count > 1 ? out[count - 2] : *upper;
  std::fill(line_.begin() + (count - 1), line_.end(), last);
}

void RowScanner::find_runs(int contrast) {
  const std::size_t blocks = line_.size() / kBlock;
  block_min_.resize(blocks + 2);
  block_max_.resize(blocks + 2);
  for (std::size_t b = 0; b < blocks; ++b) {
    const std::uint8_t* p = line_.data() + b * kBlock;
    std::uint8_t low = 255, high = 0;
    for (int i = 0; i < kBlock; ++i) {
      low = std::min(low, p[i]);
      high = std::max(high, p[i]);
    }
    block_min_[b + 1] = low;
    block_max_[b + 1] = high;
  }
  // A guard on both sides, so that every block has two neighbours.
  block_min_.front() = block_min_[1];
  block_max_.front() = block_max_[1];
  block_min_.back() = block_min_[blocks];
  block_max_.back() = block_max_[blocks];

  run_ends_.clear();
  int threshold = -1;  // none yet
  bool dark = false;
  for (std::size_t b = 0; b < blocks; ++b) {
    const int here_low = block_min_[b + 1], here_high = block_max_[b + 1];
    const int low = std::min({block_min_[b], block_min_[b + 1], block_min_[b + 2]});
    const int high = std::max({block_max_[b], block_max_[b + 1], block_max_[b + 2]});
    const bool contrasted = high - low >= contrast;
    if (contrasted) threshold = (low + high + 1) / 2;
    if (threshold < 0) {
      if (b == 0) first_run_dark_ = false;
      continue;
    }
    const int start = static_cast<int>(b) * kBlock;
    const auto classify = [&](int u, bool is_dark) {
      if (u == 0) {
        first_run_dark_ = dark = is_dark;
      } else if (is_dark != dark) {
        run_ends_.push_back(u);
        dark = is_dark;
      }
    };
    if (!contrasted || here_low >= threshold || here_high < threshold) {
      classify(start, (here_low + here_high) / 2 < threshold);
      continue;
    }
    const std::uint8_t* p = line_.data() + start;
    for (int i = 0; i < kBlock; ++i) {
      if ((p[i] < threshold) != dark || start + i == 0) classify(start + i, p[i] < threshold);
    }
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
