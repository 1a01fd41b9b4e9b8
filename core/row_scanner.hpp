#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/box.hpp"
#include "core/luma_view.hpp"

namespace roundel {

// Where a row crosses what may be a marker: dark, bright, dark.
struct Seed {
  int u = 0, v = 0;   // a pixel of the left dark run, next to the bright one
  int bright_u = 0;   // middle of the bright run
  int threshold = 0;  // half way between the levels of the runs
  int extent = 0;     // pixels from the start of the left dark run to the end of the right one
};

// Classifies single rows into dark and bright runs by local thresholds and picks the run patterns
// that a marker's centre could have made (METHOD.md section 1). The threshold of a block of pixels
// is half way between the extremes around it; where there is no contrast the last one holds on, so
// that the inside of a wide dark disc stays dark. Noise below `contrast` makes no runs.
class RowScanner {
 public:
  // Seeds are looked for in the row pairs (v, v + 1) of an area, averaged, which halves the noise:
  // v0, v0 + spacing and so on up to v1, and no further than the frame goes, as columns. The frame
  // must outlive the scan.
  void start(const LumaView& frame, const Box& area, int spacing, int contrast, int max_extent);

  // Goes on to the next row pair. False after the last one.
  bool next();

  // Of this row pair, by rising u. The span holds until the next call.
  std::span<const Seed> seeds() const { return seeds_; }

 private:
  // A smoothed row and the extremes of its blocks.
  struct Line {
    int v = 0;
    std::vector<std::uint8_t> levels;  // from u0_ on
    std::vector<std::uint8_t> block_min, block_max;
  };

  void prefetch(int v) const;
  void prepare(Line& line, int v);
  void find_runs(const Line& line);
  void find_seeds(const Line& line);

  LumaView frame_;  // of the scan at hand, as what follows
  int u0_ = 0, u1_ = 0, v_ = 0, last_v_ = 0, spacing_ = 1;
  int contrast_ = 0, max_extent_ = 0;
  std::size_t blocks_ = 0;  // that have pixels; the buffers go on with some without

  // The row pair at hand and the one to come, whose extremes are worked out well before they are
  // read: a processor is slow to give out again in other portions what it has just taken in.
  std::array<Line, 2> lines_;
  std::size_t prepared_ = 0;  // which of them is to come
  std::vector<std::uint8_t> threshold_, middle_, contrasted_, crossing_;  // LineKernels::BlockLooks
  std::vector<std::int32_t> run_ends_;  // one past each run's last pixel; colours alternate
  bool first_run_dark_ = false;
  std::vector<Seed> seeds_;
};

// Whether dark, bright and dark runs of these lengths (pixels) may lie across a marker's centre.
// The proportions hold along any line, however the marker is tilted.
bool is_marker_pattern(int dark_before, int bright, int dark_after);

// Standard deviation of the frame's pixel noise, grey levels, from differences of neighbours on a
// coarse grid (their median, so that edges do not count).
double estimate_noise(const LumaView& frame);

}  // namespace roundel
