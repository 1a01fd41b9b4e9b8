#include "bench/accuracy/circle_painter.hpp"

#include "core/necklace.hpp"

namespace roundel::bench {

CirclePainter::CirclePainter(const Experiment& experiment, MarkerKind kind)
    : experiment_(experiment), renderer_(experiment.camera, experiment.imaging) {
  const NecklaceCode code(experiment.bits, 1);
  for (int number = 0; number < experiment.markers; ++number) {
    SceneMarker print;
    print.kind = kind;
    print.bits = experiment.bits;
    print.word = code.word(number + 1).value();
    print.diameter_m = experiment.diameter_m;
    print.plate_ratio = experiment.plate_ratio;
    prints_.push_back(print);
  }
  scene_.clutter = experiment.clutter;
}

void CirclePainter::paint(const View& view, GreyImage& out) {
  scene_.markers.clear();
  for (const PlacedMarker& placed : view.markers) {
    SceneMarker marker = prints_[static_cast<std::size_t>(placed.number)];
    marker.pose = placed.pose;
    marker.velocity = placed.velocity;
    marker.spin = placed.spin;
    scene_.markers.push_back(marker);
  }
  renderer_.render(scene_, view.noise_seed, out);
}

}  // namespace roundel::bench
