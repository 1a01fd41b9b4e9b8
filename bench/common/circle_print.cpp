#include <memory>

#include "bench/common/print.hpp"
#include "core/necklace.hpp"

namespace roundel::bench {

namespace {

Drawing drawing_of(SceneMarker marker, const PlacedMarker& placed, const Experiment& experiment,
                   const Imaging& imaging, const Response& response) {
  marker.diameter_m = experiment.diameter_m;
  marker.plate_ratio = experiment.plate_ratio;
  marker.pose = placed.pose;
  marker.velocity = placed.velocity;
  marker.spin = placed.spin;
  const auto figure = std::make_shared<const Figure>(marker, imaging, response, experiment.camera);
  return {figure->visible() ? figure->box() : PixelRange{}, figure->base_light(),
          [figure, &experiment](const FineFrame& frame, CoverageGrid& base, CoverageGrid& print) {
            figure->draw(experiment.camera, frame, base, print);
          }};
}

}  // namespace

Print whycode_print(const Experiment& experiment) {
  std::vector<std::uint32_t> words;
  const NecklaceCode code(experiment.bits, 1);
  for (int id = 1; id <= code.id_count(); ++id) words.push_back(code.word(id).value());
  return [&experiment, words](const Imaging& imaging, const Response& response,
                              const PlacedMarker& placed) {
    SceneMarker marker;
    marker.kind = MarkerKind::WhyCode;
    marker.bits = experiment.bits;
    marker.word = words[static_cast<std::size_t>(placed.number) % words.size()];
    return drawing_of(marker, placed, experiment, imaging, response);
  };
}

Print whycon_print(const Experiment& experiment) {
  return
      [&experiment](const Imaging& imaging, const Response& response, const PlacedMarker& placed) {
        SceneMarker marker;
        marker.kind = MarkerKind::WhyCon;
        return drawing_of(marker, placed, experiment, imaging, response);
      };
}

}  // namespace roundel::bench
