#pragma once

#include <functional>
#include <vector>

#include "bench/common/experiment.hpp"
#include "bench/common/square_pattern.hpp"
#include "simulator/coverage.hpp"
#include "simulator/figure.hpp"
#include "simulator/response.hpp"

namespace roundel::bench {

// A marker ready to be drawn: a flat white plate and, relative to its light, what is printed on it
// (see CoverageGrid and Figure::draw). May borrow what it was made from.
struct Drawing {
  PixelRange box;  // pixels that it touches; may reach outside of the image
  float base_light = 0;
  std::function<void(const FineFrame&, CoverageGrid& base, CoverageGrid& print)> draw;
};

// What a system has printed on the plates: makes the drawing of a placed marker under some imaging
// (the experiment's, or one that differs from it a little) and its response curve.
using Print = std::function<Drawing(const Imaging&, const Response&, const PlacedMarker&)>;

// These borrow the experiment. Of so many codes as a kind has, marker i wears number i % count.
Print whycode_print(const Experiment& experiment);
Print whycon_print(const Experiment& experiment);
Print square_print(const Experiment& experiment, std::vector<SquarePattern> patterns);

}  // namespace roundel::bench
