#include "bench/accuracy/paper_experiments.hpp"

#include <algorithm>

#include "bench/common/arena.hpp"

namespace roundel::bench {

std::vector<Experiment> paper_experiments(int thinning) {
  const auto thin = [&](int count) { return std::max(1, count / thinning); };
  const int stride = thinning > 1 ? 7 : 1;  // pan rows of the manipulator
  std::vector<Experiment> all;
  all.push_back(artificial("artificial-30", 0, 30, thin(3000)));
  all.push_back(artificial("artificial-60", 30, 60, thin(3000)));
  all.push_back(arena("arena-7", "arena 3 m, 7 markers",
                      {.robots = 7, .frames = thin(430), .peer_stride = 20}));
  all.push_back(arena("arena-30", "arena 3 m, 30 markers",
                      {.robots = 30, .frames = thin(100), .peer_stride = 10}));
  all.push_back(arena("arena-100", "arena 3 m, 100 markers",
                      {.robots = 100, .bits = 11, .frames = thin(100), .peer_stride = 10}));
  all.push_back(manipulator("manipulator-1m", 1, 2, stride));
  all.push_back(manipulator("manipulator-2m", 2, 2, stride));
  all.push_back(manipulator("manipulator-3m", 3, 2, stride));
  all.push_back(manipulator("manipulator-3m-noise", 3, 10, stride));
  all.push_back(arena("arena-gamma", "arena, 30 markers, sRGB",
                      {.robots = 30, .frames = thin(100), .srgb = true, .peer_stride = 10}));
  all.push_back(arena("arena-gamma-known", "arena, 30 markers, sRGB, curve known",
                      {.robots = 30,
                       .frames = thin(100),
                       .srgb = true,
                       .response_known = true,
                       .peer_stride = 10}));
  all.push_back(arena(
      "arena-motion", "arena, 30 markers, 20 ms at 0.3 m/s",
      {.robots = 30, .frames = thin(100), .exposure = 0.02, .peer_stride = 10, .speed = 0.3}));
  return all;
}

}  // namespace roundel::bench
