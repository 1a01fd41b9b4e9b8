#include "bench/accuracy/run.hpp"

#include <algorithm>
#include <cmath>

#include "bench/accuracy/bound.hpp"
#include "bench/common/painter.hpp"

namespace roundel::bench {

namespace {

void add_bounds(const Experiment& experiment, const Print& print, int bounds,
                std::vector<Result>& results) {
  if (results.empty() || bounds <= 0) return;
  const auto count = std::ssize(results.front().verdicts.records);
  const std::ptrdiff_t stride = std::max<std::ptrdiff_t>(1, (count + bounds - 1) / bounds);
  for (std::ptrdiff_t i = 0; i < count; i += stride) {
    const auto index = static_cast<std::size_t>(i);
    const Record& record = results.front().verdicts.records[index];
    const auto& markers = experiment.views[static_cast<std::size_t>(record.view)].markers;
    const auto marker = std::find_if(markers.begin(), markers.end(), [&](const PlacedMarker& m) {
      return m.number == record.number;
    });
    const auto bound = cramer_rao_bound(experiment, print, *marker, results.front().has_yaw);
    if (!bound) continue;
    for (Result& result : results) {
      Record& twin = result.verdicts.records[index];
      twin.bound_position = std::sqrt(bound->topLeftCorner<3, 3>().trace());
      twin.bound_rotation = std::sqrt(bound->bottomRightCorner<3, 3>().trace());
    }
  }
}

}  // namespace

std::vector<Result> run(const Experiment& experiment, const Contender& contender, int bounds) {
  const Print print = contender.print(experiment);
  Painter painter(experiment, print);
  const Systems systems = contender.systems(experiment);
  std::vector<Result> results;
  bool anyone_follows = false;
  for (const auto& system : systems) {
    results.push_back({&experiment, system->name(), system->has_yaw(), {}});
    anyone_follows = anyone_follows || system->follows();
  }
  GreyImage picture;
  for (int view = 0; view < std::ssize(experiment.views); ++view) {
    const View& shown = experiment.views[static_cast<std::size_t>(view)];
    if (!shown.judged() && !anyone_follows) continue;
    if (contender.is_peer() && view % experiment.peer_stride != 0) continue;
    painter.paint(shown, picture);
    for (std::size_t i = 0; i < systems.size(); ++i) {
      if (!shown.judged() && !systems[i]->follows()) continue;
      const auto sightings = systems[i]->look(picture.view());
      if (!shown.judged()) continue;
      judge(experiment, view, *systems[i], sightings, results[i].verdicts);
    }
  }
  add_bounds(experiment, print, bounds, results);
  return results;
}

}  // namespace roundel::bench
