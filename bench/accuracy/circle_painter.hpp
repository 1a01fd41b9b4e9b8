#pragma once

#include "bench/accuracy/painter.hpp"
#include "simulator/renderer.hpp"

namespace roundel::bench {

// WhyCon or WhyCode markers, by the simulator. The experiment must outlive the object.
class CirclePainter final : public Painter {
 public:
  CirclePainter(const Experiment& experiment, MarkerKind kind);
  void paint(const View& view, GreyImage& out) override;

 private:
  const Experiment& experiment_;
  Renderer renderer_;
  std::vector<SceneMarker> prints_;  // by PlacedMarker::number
  Scene scene_;
};

}  // namespace roundel::bench
