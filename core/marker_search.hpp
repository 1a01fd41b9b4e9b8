#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/detector_parameters.hpp"
#include "core/luma_view.hpp"
#include "core/row_scanner.hpp"
#include "core/segment.hpp"

namespace roundel {

// Looks for markers whose place is not known. One pass over the rows of an area finds all of them
// together; rows are visited at a spacing below the height of the smallest marker's bright centre
// (METHOD.md section 1). What is known already is claimed first and costs nothing again.
class MarkerSearch {
 public:
  explicit MarkerSearch(const DetectorParameters& parameters);

  // Starts a frame: forgets the claims, measures the noise.
  void begin(const LumaView& frame);

  // Grows a segment at a known place; a success claims its area.
  Verdict examine(const LumaView& frame, int u, int v, int threshold,
                  const RegionFiller::Limits& limits);
  const Segment& segment() const { return finder_.segment(); }

  // Claims the area of a marker that is known to be there.
  void claim(const Ellipse& outline, int frame_height);

  // Whether a pixel lies in a marker found in this frame.
  bool is_claimed(int u, int v) const { return is_owned(u, v, Owner::kMarker); }

  // Appends the segments whose centre disc is crossed by rows first_v, first_v + spacing, ...
  // inside the area, up to `limit` segments in all; claims them.
  void search(const LumaView& frame, const Box& area, int spacing, std::size_t limit,
              std::vector<Segment>& found);

  // Row spacing that misses no marker of the smallest permitted size.
  int smallest_spacing() const { return smallest_spacing_; }

 private:
  // Pixels u0 ... u1 of a row that belong to something known: a marker, with all that lies inside
  // of it, the dark part of what turned out to be none, or of what grew beyond a seed's limits.
  enum class Owner : std::int32_t { kMarker, kNoMarker, kTooLarge };
  struct Claim {
    std::int32_t u0, u1, next_in_row;
    Owner owner;
    std::int32_t fill;  // of kTooLarge: which of the fills given up
  };
  // A fill that was given up. Another one in the same region, of a threshold not much below and
  // limits not much above, would end likewise.
  struct GivenUp {
    int threshold = 0;
    RegionFiller::Limits limits;
  };
  struct RowHead {
    std::uint32_t stamp = 0;
    std::int32_t first = -1;
  };

  void claim_segment();
  void claim(const Run& run, Owner owner, std::int32_t fill = -1);
  bool is_hopeless(const Seed& seed, const RegionFiller::Limits& limits) const;
  bool is_owned(int u, int v, Owner owner) const;
  // Whether one of the claims on a pixel is as wanted.
  template <typename Wanted>
  bool has_claim(int u, int v, const Wanted& wanted) const;

  DetectorParameters parameters_;
  int smallest_spacing_ = 1;
  int contrast_ = 0;  // grey levels that count as an edge in this frame
  RowScanner scanner_;
  SegmentFinder finder_;
  std::vector<Claim> claims_;
  std::vector<GivenUp> given_up_;
  std::vector<RowHead> rows_;
  std::uint32_t stamp_ = 0;
};

}  // namespace roundel
