#pragma once

#include "bench/common/experiment.hpp"

namespace roundel::bench {

// The noisy floor: Full HD, 8.4 cm markers (41 px) on a cluttered floor, noise 3, blur 0.7.
Experiment floor_scene(int robots, int frames);

// The same without clutter and noise.
Experiment clean_scene(int robots, int frames);

// 4K with markers of 20 px. Of more than 99 markers ids are worn more than once.
Experiment crowd_scene(int robots, int frames);

// The floor with markers of 41 px, at a width of 1280, 1920 or 3840 pixels.
Experiment resolution_scene(int width, int robots, int frames);

}  // namespace roundel::bench
