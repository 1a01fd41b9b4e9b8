#pragma once

#include <vector>

#include "bench/accuracy/painter.hpp"
#include "bench/accuracy/square_figure.hpp"
#include "simulator/noise.hpp"
#include "simulator/optics.hpp"
#include "simulator/response.hpp"

namespace roundel::bench {

// Square tags by the simulator's own coverage, optics, response and noise: a picture differs from
// CirclePainter's in the prints alone, down to the noise of every pixel. Uneven light is not drawn.
class SquarePainter final : public Painter {
 public:
  // The experiment must outlive the object. Marker i wears patterns[i % size].
  SquarePainter(const Experiment& experiment, std::vector<SquarePattern> patterns);
  void paint(const View& view, GreyImage& out) override;

 private:
  void compose(const Box& tile, const std::vector<SquareFigure>& tags);
  template <typename Draw>
  void paint_figure(const Box& figure_box, const Box& area, float base_light, Draw&& draw);

  const Experiment& experiment_;
  std::vector<SquarePattern> patterns_;
  Box image_;
  Response response_;
  Optics optics_;
  NoiseTable noise_;
  float floor_, white_, ink_;  // light; ink is relative to white
  std::vector<Figure> clutter_;
  std::vector<std::int16_t> empty_, grey_;  // without tags; with them. Response's fixed point
  std::vector<float> fine_, pixels_;        // of one tile
  CoverageGrid base_, print_;
};

}  // namespace roundel::bench
