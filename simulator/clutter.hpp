#pragma once

#include <cstdint>
#include <vector>

#include "core/pose.hpp"
#include "simulator/scene.hpp"

namespace roundel {

// Things that lie on an arena's floor and around it: papers, boxes, cables, and shapes that pass
// some of a marker's tests: discs, thin rings, discs with a small, a square or an off-centre hole,
// square frames. None of them is a marker of accepted proportions (inner ratio 0.33 to 0.60).
std::vector<SceneShape> arena_clutter(std::uint64_t seed, double length_m, double width_m,
                                      const Pose& arena_in_camera);

}  // namespace roundel
