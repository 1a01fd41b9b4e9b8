// Prints what the vector units and the tracker make of fixed input, for ./dev arm64 to hold the
// figures of two processors against each other.
//   same_figures film > FILM      frames of the simulated arena
//   same_figures kernels < FILM   checksums: they are the same to the bit
//   same_figures poses < FILM     as they are tracked

#include <fmt/format.h>

#include <bit>
#include <cstdint>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/photometric_kernel.hpp"
#include "core/row_scanner.hpp"
#include "core/tracker.hpp"
#include "simulator/arena.hpp"
#include "tests/random.hpp"

namespace roundel {
namespace {

using test::Random;

// FNV-1a over bits, so that one of them is enough for another sum.
class Checksum {
 public:
  void add(std::uint32_t bits) {
    for (int i = 0; i < 4; ++i) {
      sum_ = (sum_ ^ (bits >> (8 * i) & 0xFF)) * 0x100000001B3U;
    }
  }
  void add(int value) { add(static_cast<std::uint32_t>(value)); }
  void add(float value) { add(std::bit_cast<std::uint32_t>(value)); }
  std::uint64_t sum() const { return sum_; }

 private:
  std::uint64_t sum_ = 0xCBF29CE484222325U;
};

struct Pixels {
  std::vector<float> x, y, grey, weight;

  // Around a marker at the middle, 20 pixels to its rim, of grey levels between dark and bright.
  explicit Pixels(int count) {
    Random random(5);
    for (int i = 0; i < count; ++i) {
      x.push_back(static_cast<float>(random.uniform(-0.022, 0.022)));
      y.push_back(static_cast<float>(random.uniform(-0.022, 0.022)));
      grey.push_back(static_cast<float>(random.uniform(20, 230)));
      weight.push_back(static_cast<float>(random.uniform(0.2, 0.6)));
    }
  }
  PixelColumns columns() const {
    return {x.data(), y.data(), grey.data(), weight.data(), static_cast<int>(x.size()), 1};
  }
};

PhotometricModel model_of(int halves) {
  PhotometricModel model{};
  model.at = {0.003F, -0.002F, 1.01F};
  model.by_x = {50.0F, 1.5F, 0.4F};
  model.by_y = {-1.3F, 49.0F, -0.3F};
  model.by_u = {0.05F, 0.001F, 0.0004F};
  model.by_v = {-0.0003F, 0.048F, -0.0003F};
  model.eye = {4.0F, -3.0F, 49.0F};
  model.dark = 35;
  model.contrast = 180;
  model.slope_x = 0.02F;
  model.slope_y = -0.01F;
  model.blur = 0.7F;
  model.shift = 0.05F;
  model.stretch_u = 0.03F;
  model.stretch_d = -0.02F;
  model.inner = 0.41F;
  model.halves = halves;
  model.colours = {0x2D4B, 0x5A96, 0xB52D, 0x6A5B, 0xD4B6};
  model.robust_scale = 8;
  model.outlier = 60;
  return model;
}

std::uint64_t sums_of(VectorUnit unit) {
  const Pixels pixels(32 * kPixelBlock);
  Checksum checksum;
  for (const int halves : {0, 16}) {
    for (const auto add : {add_outer_pixels, add_inner_pixels}) {
      for (const int unknowns : {int{kFollowedUnknowns}, int{kCodeUnknowns}}) {
        PhotometricSums sums;
        add(model_of(halves), pixels.columns(), unknowns, sums, unit);
        for (const float x : sums.normal_matrix) checksum.add(x);
        for (const float x : sums.right_side) checksum.add(x);
        checksum.add(sums.squares);
        checksum.add(sums.weights);
      }
    }
  }
  return checksum.sum();
}

// Frames of the simulated arena, which the other modes read: the same pictures for everybody.
constexpr int kFrames = 8;

void write_film() {
  Arena arena(ArenaOptions{});
  GreyImage picture;
  for (int frame = 0; frame < kFrames; ++frame) {
    arena.render(frame, picture);
    if (std::fwrite(picture.pixels.data(), 1, picture.pixels.size(), stdout) !=
        picture.pixels.size()) {
      throw std::runtime_error("the film can't be written");
    }
  }
}

void read_frame(const CameraModel& camera, GreyImage& picture) {
  picture.resize(camera.width, camera.height);
  if (std::fread(picture.pixels.data(), 1, picture.pixels.size(), stdin) != picture.pixels.size()) {
    throw std::runtime_error("the film ends too early");
  }
}

void print_kernels() {
  fmt::print("sums, best vector unit: {:016x}\n", sums_of(VectorUnit::kBest));
  fmt::print("sums, baseline: {:016x}\n", sums_of(VectorUnit::kBaseline));

  GreyImage picture;
  read_frame(Arena(ArenaOptions{}).camera(), picture);
  RowScanner scanner;
  Checksum seeds;
  int count = 0;
  scanner.start(picture.view(), {0, 0, picture.width - 1, picture.height - 1}, 2, 20, 1200);
  while (scanner.next()) {
    for (const Seed& seed : scanner.seeds()) {
      for (const int x : {seed.u, seed.v, seed.bright_u, seed.threshold, seed.extent}) seeds.add(x);
      ++count;
    }
  }
  fmt::print("{} seeds: {:016x}\n", count, seeds.sum());
}

void print_poses() {
  const ArenaOptions options;
  const CameraModel camera = Arena(options).camera();
  DetectorParameters parameters;
  parameters.diameter_m = options.diameter_m;
  Tracker tracker(parameters, camera);
  GreyImage picture;
  for (int frame = 0; frame < kFrames; ++frame) {
    read_frame(camera, picture);
    for (const Marker& marker : tracker.track(picture.view())) {
      const auto& p = marker.pose.position;
      const auto& q = marker.pose.orientation;
      fmt::print("{} {} {}", frame, marker.track, marker.id);
      for (const double x : {marker.u, marker.v, p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z()}) {
        fmt::print(" {:.17g}", x);
      }
      fmt::print("\n");
    }
  }
}

}  // namespace
}  // namespace roundel

int main(int argc, char** argv) {
  const std::string what = argc == 2 ? argv[1] : "";
  try {
    if (what == "film") {
      roundel::write_film();
    } else if (what == "kernels") {
      roundel::print_kernels();
    } else if (what == "poses") {
      roundel::print_poses();
    } else {
      throw std::invalid_argument("say film, kernels or poses");
    }
  } catch (const std::exception& error) {
    fmt::print(stderr, "same_figures: {}\n", error.what());
    return 1;
  }
  return 0;
}
