// Tracks a fixed scene for tests/ceilings/count.sh, which counts the instructions of the calls of
// counted_frame() alone.
//   counted_frames N [FRAMES]: N markers of 41 px on the floor of the simulated arena, in Full HD

#include <cstdlib>
#include <iostream>
#include <stdexcept>
#include <string>

#include "core/tracker.hpp"
#include "simulator/arena.hpp"

namespace {

constexpr int kWarmUp = 7;  // frames: newcomers are found within five

std::size_t frame(roundel::Tracker& tracker, const roundel::GreyImage& picture) {
  return tracker.track(picture.view()).size();
}

}  // namespace

// The name that callgrind looks for.
extern "C" __attribute__((noinline)) std::size_t counted_frame(roundel::Tracker& tracker,
                                                               const roundel::GreyImage& picture) {
  return frame(tracker, picture);
}

int main(int argc, char** argv) {
  try {
    if (argc < 2 || argc > 3) throw std::invalid_argument("usage: counted_frames N [FRAMES]");
    const int markers = std::stoi(argv[1]), frames = argc > 2 ? std::stoi(argv[2]) : 5;
    roundel::ArenaOptions options;
    options.robots = markers;
    options.diameter_m = 0.084;
    options.plate_ratio = 1.35;
    options.corners = false;
    roundel::Arena arena(options);
    roundel::DetectorParameters parameters;
    parameters.diameter_m = options.diameter_m;
    roundel::Tracker tracker(parameters, arena.camera());
    roundel::GreyImage picture;
    for (int i = 0; i < kWarmUp; ++i) {
      arena.render(i, picture);
      frame(tracker, picture);
    }
    for (int i = kWarmUp; i < kWarmUp + frames; ++i) {
      arena.render(i, picture);
      const std::size_t seen = counted_frame(tracker, picture);
      if (seen != static_cast<std::size_t>(markers)) {
        throw std::runtime_error(std::to_string(seen) + " of " + std::to_string(markers) +
                                 " markers were tracked in frame " + std::to_string(i));
      }
    }
  } catch (const std::exception& e) {
    std::cerr << "counted_frames: " << e.what() << '\n';
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
