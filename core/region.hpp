#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/box.hpp"
#include "core/luma_view.hpp"
#include "core/moments.hpp"

namespace roundel {

// Pixels u0 ... u1 of row v, both ends included.
struct Run {
  int v = 0, u0 = 0, u1 = 0;
};

enum class FillResult {
  kComplete,     // the whole connected region, away from the image border
  kNoSeed,       // the first pixel is not dark
  kTouchesEdge,  // the region reaches the image border: it is cut off
  kTooLarge      // given up at the size limit
};

// A connected dark region and what follows from its outer outline.
struct Region {
  int origin_u = 0, origin_v = 0;  // of both moments
  Box box;
  Moments dark;    // the region's own pixels
  Moments filled;  // every row filled from the region's first pixel to its last: for a convex
                   // outline the whole interior, whatever specks and patterns lie within
};

// Collects connected regions of dark pixels by runs: pixels are compared with the threshold when
// they are first touched, 64 of a row at once, and no label image exists or is cleared ([P] 3;
// METHOD.md section 1). Eight-connected, so that a thin tilted ring holds together. Memory is
// reused from region to region.
class RegionFiller {
 public:
  struct Limits {
    int max_width = 1 << 14, max_height = 1 << 14;  // pixels; a wider or higher region is given up
  };

  // The dark region (luma < threshold) that holds pixel (u, v), which must lie in the frame.
  FillResult fill(const LumaView& frame, int u, int v, int threshold, const Limits& limits);

  const Region& region() const { return region_; }

  // Calls back with every dark run that the last fill came across, also when it was given up.
  template <typename Use>
  void for_each_run(const Use& use) const {
    for (const Run& run : runs_) use(run);
  }

  // First and last pixel of every row of the last complete region, from box.v0 on.
  std::span<const Run> row_spans() const { return spans_; }

 private:
  // 64 pixels of a row: which of them are dark and not yet in a run. Made when first touched; the
  // words of earlier fills are void.
  struct Word {
    std::uint64_t dark = 0;
    std::uint32_t stamp = 0;
  };

  Word& word(int column, int v);
  std::uint64_t classify(int column, int v) const;
  FillResult append(int u, int v);
  FillResult append_neighbours(const Run& run, int v);
  FillResult grow(int u, int v);
  void summarise(int u, int v);

  LumaView frame_;  // of the fill at hand, as what follows
  std::uint8_t threshold_ = 0;
  Limits limits_;
  Box box_;

  std::vector<Run> runs_;  // in order of discovery
  std::vector<Run> open_;  // of these, what has not been looked around yet
  // What the limits let a fill reach, row by row: packed, so that a marker's words fit into the
  // nearest cache.
  std::vector<Word> words_;
  int first_row_ = 0, first_column_ = 0, columns_ = 0;
  std::vector<Run> spans_;
  std::uint32_t stamp_ = 0;
  Region region_;
};

}  // namespace roundel
