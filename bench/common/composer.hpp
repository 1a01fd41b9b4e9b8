#pragma once

#include <span>
#include <vector>

#include "bench/common/print.hpp"
#include "simulator/optics.hpp"

namespace roundel::bench {

// Floor, clutter and drawings through the lens onto the pixels: the simulator's coverage and optics
// around any kind of print. Uneven light is not drawn.
class Composer {
 public:
  Composer(const CameraModel& camera, const Imaging& imaging,
           const std::vector<SceneShape>& clutter);

  const Response& response() const { return response_; }
  int margin() const { return optics_.margin(); }  // pixels that blur carries light

  // Light of a piece of the picture, row by row; drawings cover each other in their order. The
  // result holds until the next call.
  const std::vector<float>& compose(const PixelRange& piece, std::span<const Drawing> drawings);

 private:
  void paint(const Drawing& drawing, const PixelRange& area);

  Response response_;
  Optics optics_;
  float floor_ = 0;  // light
  std::vector<Drawing> clutter_;
  std::vector<float> fine_, pixels_;
  CoverageGrid base_, print_;
};

}  // namespace roundel::bench
