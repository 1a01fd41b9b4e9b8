#pragma once

#include "bench/accuracy/experiment.hpp"
#include "core/grey_image.hpp"

namespace roundel::bench {

// Takes an experiment's pictures with one kind of print on the plates.
class Painter {
 public:
  virtual ~Painter() = default;
  virtual void paint(const View& view, GreyImage& out) = 0;
};

}  // namespace roundel::bench
