#include "bench/accuracy/contender.hpp"

#include <iterator>

#include "bench/accuracy/apriltag_system.hpp"
#include "bench/accuracy/aruco_system.hpp"
#include "bench/accuracy/circle_painter.hpp"
#include "bench/accuracy/roundel_system.hpp"

namespace roundel::bench {

namespace {

Contender roundel_contender(const std::string& name, MarkerKind kind) {
  return {name,
          [kind](const Experiment& experiment) {
            return std::make_unique<CirclePainter>(experiment, kind);
          },
          [kind](const Experiment& experiment) {
            return roundel_systems(experiment, kind == MarkerKind::WhyCode);
          }};
}

}  // namespace

std::vector<Contender> all_contenders() {
  std::vector<Contender> all = {roundel_contender("roundel", MarkerKind::WhyCode),
                                roundel_contender("roundel-whycon", MarkerKind::WhyCon)};
  [[maybe_unused]] const auto add = [&](std::vector<Contender> some) {
    std::move(some.begin(), some.end(), std::back_inserter(all));
  };
#ifdef ROUNDEL_BENCH_APRILTAG
  add(apriltag_contenders());
#endif
#ifdef ROUNDEL_BENCH_ARUCO
  add(aruco_contenders());
#endif
  return all;
}

std::vector<Result> run(const Experiment& experiment, const Contender& contender) {
  const std::unique_ptr<Painter> painter = contender.painter(experiment);
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
    painter->paint(shown, picture);
    for (std::size_t i = 0; i < systems.size(); ++i) {
      if (!shown.judged() && !systems[i]->follows()) continue;
      const auto sightings = systems[i]->look(picture.view());
      if (!shown.judged()) continue;
      judge(experiment, view, *systems[i], sightings, results[i].verdicts);
    }
  }
  return results;
}

}  // namespace roundel::bench
