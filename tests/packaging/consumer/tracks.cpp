// The tracker, used by somebody else's program: a disc with a hole, drawn here, is a marker.
#include <roundel/core/tracker.hpp>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

int main() {
  constexpr int kWidth = 320, kHeight = 240;
  std::vector<std::uint8_t> pixels(kWidth * kHeight);
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 0; u < kWidth; ++u) {
      const double radius = std::hypot(u - 150, v - 100);
      const bool dark = radius < 40 && radius > 40 * 50 / 122.0;
      pixels[v * kWidth + u] = dark ? 30 : 220;
    }
  }
  roundel::DetectorParameters parameters;
  parameters.bits = 0;
  roundel::Tracker tracker(parameters, std::nullopt);
  std::size_t found = 0;
  for (int frame = 0; frame < 3; ++frame) {
    found = tracker.track(roundel::grey_view(pixels.data(), kWidth, kHeight, kWidth)).size();
  }
  std::printf("%zu\n", found);
  return found == 1 ? 0 : 1;
}
