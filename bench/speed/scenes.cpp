#include "bench/speed/scenes.hpp"

#include "bench/common/arena.hpp"

namespace roundel::bench {

namespace {

constexpr double kDiameter = 0.084;  // 41 px in Full HD
constexpr int kManyBits = 11;        // codes for up to 186 markers
int bits_for(int robots) {
  return robots <= 30 ? 8 : kManyBits;
}

}  // namespace

Experiment floor_scene(int robots, int frames) {
  return arena("floor", "noisy floor",
               {.robots = robots, .bits = bits_for(robots), .frames = frames});
}

Experiment clean_scene(int robots, int frames) {
  return arena("clean", "clean picture",
               {.robots = robots,
                .bits = bits_for(robots),
                .frames = frames,
                .noise_sigma = 0,
                .clutter = false});
}

Experiment crowd_scene(int robots, int frames) {
  constexpr int kWidth = 3840;
  return arena("crowd", "4K, 20 px",
               {.robots = robots,
                .frames = frames,
                .width = kWidth,
                .height = kWidth * 9 / 16,
                .diameter_m = kDiameter * 20 / 41 * 1920 / kWidth});
}

Experiment resolution_scene(int width, int robots, int frames) {
  return arena("resolution", "noisy floor",
               {.robots = robots,
                .bits = bits_for(robots),
                .frames = frames,
                .width = width,
                .height = width * 9 / 16,
                .diameter_m = kDiameter * 1920 / width});
}

}  // namespace roundel::bench
