#pragma once

#include <optional>
#include <span>

#include "core/detector_parameters.hpp"
#include "core/luma_view.hpp"
#include "core/marker.hpp"
#include "core/region.hpp"

namespace roundel {

// Grey levels of a marker's own black and of the white around it.
struct Levels {
  double dark = 0, bright = 0;
  double contrast() const { return bright - dark; }
  // Half way between the levels, not between means that hold edge pixels (METHOD.md section 9.6).
  double middle() const { return (dark + bright) / 2; }
};

// A dark ring around something bright: what passed the tests of [P] section 3.
struct Segment {
  Ellipse ellipse;          // of the outer outline
  Ellipse inner;            // moment ellipse of the bright part inside
  double bright_share = 0;  // of the bright part's area in the whole outline's
  Levels levels;
  int threshold = 0;  // luma below it is dark
  Box box;
};

// Why a candidate was turned down, in the order in which the tests are made.
enum class Verdict {
  kAccepted,
  kNotDark,  // the seed pixel is not below the threshold
  kCutOff,   // reaches the image border
  kTooLarge,
  kTooSmall,
  kBoxFill,  // the filled outline is no ellipse of its bounding box
  kCentreNotBright,
  kAreaRatio,  // dark to bright area
  kNotConcentric,
  kNotElliptic,    // area of the moment ellipse against pixels
  kRingNotClosed,  // not dark all around, or not darker than the margin
  kKnown           // found before in this frame (MarkerSearch)
};

// Grows a candidate from one dark pixel and tests it, from cheap to dear, leaving at the first
// failure. Keeps its working memory from call to call.
class SegmentFinder {
 public:
  explicit SegmentFinder(const DetectorParameters& parameters);

  // (u, v): a pixel of the candidate's dark part. `limits` bound the region's box, pixels.
  Verdict examine(const LumaView& frame, int u, int v, int threshold,
                  const RegionFiller::Limits& limits);

  const Segment& segment() const { return segment_; }

  // Every dark run of the last candidate, also of one that was turned down.
  template <typename Use>
  void for_each_run(const Use& use) const {
    filler_.for_each_run(use);
  }

  // Rows of the last accepted segment's outline.
  std::span<const Run> row_spans() const { return filler_.row_spans(); }

 private:
  Verdict examine_once(const LumaView& frame, int u, int v, int threshold,
                       const RegionFiller::Limits& limits);

  DetectorParameters parameters_;
  double min_area_ratio_ = 0, max_area_ratio_ = 0;
  RegionFiller filler_;
  Segment segment_;
};

// Levels of the marker that covers an ellipse: dark from the middle of its ring, bright from the
// margin around it. Nothing where the ring is not evenly dark or not darker than the margin by
// min_contrast.
std::optional<Levels> measure_levels(const LumaView& frame, const Ellipse& ellipse,
                                     int min_contrast);

}  // namespace roundel
