#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

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
  // Seeds of the row pair v, v + 1 (averaged, which halves the noise), by rising u; v + 1 must be
  // in the frame. Columns u0 ... u1 (both included) are looked at. The span holds until the next
  // call.
  std::span<const Seed> scan(const LumaView& frame, int v, int u0, int u1, int contrast,
                             int max_extent);

 private:
  void smooth(const LumaView& frame, int v, int u0, int u1);
  void find_runs(int contrast);

  std::vector<std::uint8_t> line_;  // the smoothed row from u0 on
  std::size_t blocks_ = 0;          // that have pixels; the buffers go on with some without
  std::vector<std::uint8_t> block_min_, block_max_;
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
