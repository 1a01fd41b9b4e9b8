#include "core/region.hpp"

#include <algorithm>

namespace roundel {

namespace {

// kStride 0 stands for a stride known only at run time.
template <int kStride>
struct RowReader {
  const std::uint8_t* row;
  std::ptrdiff_t stride;
  std::uint8_t operator[](int u) const {
    if constexpr (kStride == 0) {
      return row[u * stride];
    } else {
      return row[u * kStride];
    }
  }
};

}  // namespace

template <int kPixelStride>
FillResult RegionFiller::fill_with_stride(const LumaView& frame, int u, int v, int threshold,
                                          const Limits& limits) {
  const int last_u = frame.width - 1, last_v = frame.height - 1;
  if (RowReader<kPixelStride>{frame.row(v), frame.pixel_stride}[u] >= threshold) {
    return FillResult::kNoSeed;
  }
  Box box{u, v, u, v};

  // Appends the run around a dark pixel of row `row_v`; false when the region must be given up.
  FillResult verdict = FillResult::kComplete;
  const auto append = [&](int inside_u, int row_v) {
    const RowReader<kPixelStride> row{frame.row(row_v), frame.pixel_stride};
    int u0 = inside_u, u1 = inside_u;
    while (u0 > 0 && row[u0 - 1] < threshold) --u0;
    while (u1 < last_u && row[u1 + 1] < threshold) ++u1;
    if (u0 == 0 || u1 == last_u || row_v == 0 || row_v == last_v) {
      verdict = FillResult::kTouchesEdge;
      return u1;
    }
    box.u0 = std::min(box.u0, u0);
    box.u1 = std::max(box.u1, u1);
    box.v0 = std::min(box.v0, row_v);
    box.v1 = std::max(box.v1, row_v);
    if (box.width() > limits.max_width || box.height() > limits.max_height) {
      verdict = FillResult::kTooLarge;
      return u1;
    }
    RowHead& head = rows_[static_cast<std::size_t>(row_v)];
    if (head.stamp != stamp_) head = {stamp_, -1};
    runs_.push_back({{row_v, u0, u1}, head.first});
    head.first = static_cast<std::int32_t>(runs_.size() - 1);
    return u1;
  };

  append(u, v);
  for (std::size_t next = 0; next < runs_.size() && verdict == FillResult::kComplete; ++next) {
    const Run run = runs_[next].run;
    for (int row_v = run.v - 1; row_v <= run.v + 1; row_v += 2) {
      const RowReader<kPixelStride> row{frame.row(row_v), frame.pixel_stride};
      for (int x = run.u0 - 1; x <= run.u1 + 1; ++x) {
        if (row[x] >= threshold) continue;
        const RowHead& head = rows_[static_cast<std::size_t>(row_v)];
        int known_end = -1;
        for (std::int32_t i = head.stamp == stamp_ ? head.first : -1; i >= 0;
             i = runs_[static_cast<std::size_t>(i)].next_in_row) {
          const Run& known = runs_[static_cast<std::size_t>(i)].run;
          if (x >= known.u0 && x <= known.u1) {
            known_end = known.u1;
            break;
          }
        }
        x = known_end >= 0 ? known_end : append(x, row_v);
        if (verdict != FillResult::kComplete) return verdict;
      }
    }
  }
  region_.box = box;
  return verdict;
}

void RegionFiller::summarise(int u, int v) {
  region_.origin_u = u;
  region_.origin_v = v;
  region_.dark = {};
  region_.filled = {};
  spans_.assign(static_cast<std::size_t>(region_.box.height()), Run{0, 1 << 30, -1});
  for (const StoredRun& stored : runs_) {
    const Run& run = stored.run;
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
  if (rows_.size() < static_cast<std::size_t>(frame.height)) {
    rows_.assign(static_cast<std::size_t>(frame.height), RowHead{});
    spans_.reserve(static_cast<std::size_t>(frame.height));
    stamp_ = 0;
  }
  if (++stamp_ == 0) {  // after 2^32 regions the old stamps would come to life again
    std::fill(rows_.begin(), rows_.end(), RowHead{});
    stamp_ = 1;
  }
  runs_.clear();
  FillResult result = FillResult::kNoSeed;
  switch (frame.pixel_stride) {
    case 1:
      result = fill_with_stride<1>(frame, u, v, threshold, limits);
      break;
    case 2:
      result = fill_with_stride<2>(frame, u, v, threshold, limits);
      break;
    default:
      result = fill_with_stride<0>(frame, u, v, threshold, limits);
  }
  if (result == FillResult::kComplete) summarise(u, v);
  return result;
}

}  // namespace roundel
