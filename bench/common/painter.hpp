#pragma once

#include <cstdint>
#include <vector>

#include "bench/common/composer.hpp"
#include "core/grey_image.hpp"
#include "simulator/noise.hpp"

namespace roundel::bench {

// Takes an experiment's pictures with one kind of print on the plates. Pictures of two prints
// differ in nothing else, down to the noise of every pixel; with circular prints they are
// Renderer's.
class Painter {
 public:
  // The experiment must outlive the object.
  Painter(const Experiment& experiment, Print print);
  void paint(const View& view, GreyImage& out);

 private:
  void compose(const PixelRange& piece, std::span<const Drawing> drawings);

  const Experiment& experiment_;
  Print print_;
  PixelRange image_;
  Composer composer_;
  NoiseTable noise_;
  std::vector<std::int16_t> empty_, grey_;  // without markers; with them. Response's fixed point
};

}  // namespace roundel::bench
