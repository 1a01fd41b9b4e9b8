#pragma once

#include "core/camera_model.hpp"

namespace roundel::test {

// A camera without distortion that looks through the middle of its picture; focal length in pixels.
inline CameraModel pinhole(int width, int height, double focal) {
  CameraModel camera;
  camera.width = width;
  camera.height = height;
  camera.fx = camera.fy = focal;
  camera.cx = 0.5 * (width - 1);
  camera.cy = 0.5 * (height - 1);
  return camera;
}

}  // namespace roundel::test
