#include "core/region.hpp"

#include <algorithm>
#include <array>
#include <bit>

#include "core/byte_bits.hpp"

namespace roundel {

namespace {

constexpr int kWord = 64;  // pixels
constexpr std::uint64_t kAll = ~std::uint64_t{0};

// Bits first ... last of a word, both included.
std::uint64_t bits_between(int first, int last) {
  return (kAll << static_cast<unsigned>(first)) & (kAll >> static_cast<unsigned>(kWord - 1 - last));
}

}  // namespace

__attribute__((noinline)) std::uint64_t RegionFiller::classify(int column, int v) const {
  const int u = column * kWord, count = std::min(kWord, frame_.width - u);
  const std::uint8_t* luma = frame_.row(v) + u * frame_.pixel_stride;
  constexpr int kAhead = 2;  // rows: fills go downward first
  if (v + kAhead < frame_.height) __builtin_prefetch(luma + kAhead * frame_.row_stride);
  if (frame_.pixel_stride == 1 && count == kWord) return bits_of_64_below(luma, threshold_);
  if (frame_.pixel_stride == 2 && u + kWord < frame_.width) {
    return bits_of_64_below_every_second(luma, threshold_);
  }
  std::array<std::uint8_t, kWord> bytes{};
  bytes.fill(255);  // never below a threshold
  for (int i = 0; i < count; ++i) {
    bytes[static_cast<std::size_t>(i)] = luma[i * frame_.pixel_stride];
  }
  return bits_of_64_below(bytes.data(), threshold_);
}

inline RegionFiller::Word& RegionFiller::word(int column, int v) {
  Word& word =
      words_[static_cast<std::size_t>(v - first_row_) * static_cast<std::size_t>(columns_) +
             static_cast<std::size_t>(column - first_column_)];
  if (word.stamp != stamp_) [[unlikely]] {
    word = {classify(column, v), stamp_};
  }
  return word;
}

// Takes the run around a dark pixel that is in none yet.
FillResult RegionFiller::append(int u, int v) {
  int column = u / kWord;
  Word* here = &word(column, v);
  int first = u % kWord;
  // Clear bits below and above the pixel end the run, if there are any in this word.
  const std::uint64_t below = ~here->dark & ~(kAll << static_cast<unsigned>(first));
  const std::uint64_t above = ~here->dark & (kAll << static_cast<unsigned>(first));
  first = below != 0 ? kWord - std::countl_zero(below) : 0;
  const int last = above != 0 ? std::countr_zero(above) - 1 : kWord - 1;
  here->dark &= ~bits_between(first, last);
  int u0 = column * kWord + first, u1 = column * kWord + last;
  for (int left = column; left > first_column_ && u0 == left * kWord;) {
    Word& next = word(--left, v);
    const int length = std::countl_one(next.dark);
    if (length == 0) break;
    next.dark &= ~bits_between(kWord - length, kWord - 1);
    u0 -= length;
  }
  while (u1 % kWord == kWord - 1 && ++column < first_column_ + columns_) {
    Word& next = word(column, v);
    const int length = std::countr_one(next.dark);
    if (length == 0) break;
    next.dark &= ~bits_between(0, length - 1);
    u1 += length;
  }
  if (u0 == 0 || u1 == frame_.width - 1 || v == 0 || v == frame_.height - 1) {
    return FillResult::kTouchesEdge;
  }
  box_.u0 = std::min(box_.u0, u0);
  box_.u1 = std::max(box_.u1, u1);
  box_.v0 = std::min(box_.v0, v);
  box_.v1 = std::max(box_.v1, v);
  if (box_.width() > limits_.max_width || box_.height() > limits_.max_height) {
    return FillResult::kTooLarge;
  }
  runs_.push_back({v, u0, u1});
  open_.push_back({v, u0, u1});
  return FillResult::kComplete;
}

// Takes the runs of row v that touch a run of the row above or below.
FillResult RegionFiller::append_neighbours(const Run& run, int v) {
  const int u0 = run.u0 - 1, u1 = run.u1 + 1;
  for (int column = u0 / kWord; column <= u1 / kWord; ++column) {
    const int start = column * kWord;
    const std::uint64_t touching =
        bits_between(std::max(0, u0 - start), std::min(kWord - 1, u1 - start));
    Word& here = word(column, v);
    while ((here.dark & touching) != 0) {
      const FillResult result = append(start + std::countr_zero(here.dark & touching), v);
      if (result != FillResult::kComplete) return result;
    }
  }
  return FillResult::kComplete;
}

FillResult RegionFiller::grow(int u, int v) {
  if (((word(u / kWord, v).dark >> static_cast<unsigned>(u % kWord)) & 1U) == 0) {
    return FillResult::kNoSeed;
  }
  box_ = {u, v, u, v};
  FillResult result = append(u, v);
  // The newest first, and downward: what grows beyond the limits does so soon, in a straight line,
  // along which the rows to come will find it given up.
  while (!open_.empty() && result == FillResult::kComplete) {
    const Run run = open_.back();
    open_.pop_back();
    result = append_neighbours(run, run.v - 1);
    if (result == FillResult::kComplete) result = append_neighbours(run, run.v + 1);
  }
  region_.box = box_;
  return result;
}

void RegionFiller::summarise(int u, int v) {
  region_.origin_u = u;
  region_.origin_v = v;
  region_.dark = {};
  region_.filled = {};
  spans_.assign(static_cast<std::size_t>(region_.box.height()), Run{0, 1 << 30, -1});
  for (const Run& run : runs_) {
    region_.dark.add_run(run.u0 - u, run.u1 - u, run.v - v);
    Run& span = spans_[static_cast<std::size_t>(run.v - region_.box.v0)];
    span.v = run.v;
    span.u0 = std::min(span.u0, run.u0);
    span.u1 = std::max(span.u1, run.u1);
  }
  for (const Run& span : spans_) region_.filled.add_run(span.u0 - u, span.u1 - u, span.v - v);
}

FillResult RegionFiller::fill(const LumaView& frame, int u, int v, int threshold,
                              const Limits& limits) {
  const auto words = static_cast<std::size_t>((frame.width + kWord - 1) / kWord) *
                     static_cast<std::size_t>(frame.height);
  if (words_.size() < words) {
    words_.assign(words, Word{});
    spans_.reserve(static_cast<std::size_t>(frame.height));
    stamp_ = 0;
  }
  if (++stamp_ == 0) {  // after 2^32 regions the old stamps would come to life again
    std::fill(words_.begin(), words_.end(), Word{});
    stamp_ = 1;
  }
  frame_ = frame;
  threshold_ = static_cast<std::uint8_t>(std::clamp(threshold, 0, 255));
  limits_ = limits;
  // A run within the limits has neighbours a pixel further on; one that ends there is beyond them.
  first_row_ = std::max(0, v - limits.max_height);
  first_column_ = std::max(0, u - limits.max_width) / kWord;
  columns_ = std::min(frame.width - 1, u + limits.max_width) / kWord - first_column_ + 1;
  runs_.clear();
  open_.clear();
  const FillResult result = grow(u, v);
  if (result == FillResult::kComplete) summarise(u, v);
  return result;
}

}  // namespace roundel
