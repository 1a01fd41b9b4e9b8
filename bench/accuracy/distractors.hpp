#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/camera_model.hpp"
#include "core/grey_image.hpp"

namespace roundel::bench {

// Pictures of one kind with no marker in them; every number is another picture, the same in every
// run.
class Distractor {
 public:
  virtual ~Distractor() = default;
  virtual const std::string& name() const = 0;
  virtual const CameraModel& camera() const = 0;
  virtual void draw(std::uint64_t number, GreyImage& out) = 0;
};

// Clutter on an arena's floor, text, discs, rings (of inner ratios below 0.25 and above 0.70, and
// several in each other), checkerboards, blots, and contact sheets of the pictures (PNG) that
// Debian's packages have in /usr/share. The arena is
// in Full HD; other pictures are 640 x 480, with noise 0, 3 or 10.
std::vector<std::unique_ptr<Distractor>> all_distractors();

}  // namespace roundel::bench
