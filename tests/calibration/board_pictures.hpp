#pragma once

#include <vector>

#include "calibration/board.hpp"
#include "core/camera_model.hpp"
#include "core/grey_image.hpp"
#include "simulator/random.hpp"
#include "simulator/renderer.hpp"
#include "tools/board_scene.hpp"

namespace roundel::test {

// A webcam of 640 x 360: a third of Full HD, nine times as fast to render.
inline CameraModel small_webcam() {
  CameraModel camera;
  camera.width = 640;
  camera.height = 360;
  camera.fx = 484;
  camera.fy = 485;
  camera.cx = 323.4;
  camera.cy = 176.2;
  camera.distortion = {-0.28, 0.09, 0.0006, -0.0009, -0.012};
  return camera;
}

inline Imaging imaging(double noise_sigma = 2, double blur_px = 0.7) {
  Imaging result;
  result.noise_sigma = noise_sigma;
  result.blur_px = blur_px;
  return result;
}

// Takes pictures of a board.
class BoardCamera {
 public:
  BoardCamera(const Board& board, const CameraModel& camera, const Imaging& imaging,
              std::uint64_t seed = 1)
      : board_(board), renderer_(camera, imaging), seed_(seed) {}

  GreyImage take(const Pose& board_in_camera) { return take(board_scene(board_, board_in_camera)); }
  GreyImage take(const Scene& scene) {
    GreyImage image;
    renderer_.render(scene, derived_seed(seed_, ++pictures_), image);
    return image;
  }
  std::vector<GreyImage> take(const std::vector<Pose>& poses) {
    std::vector<GreyImage> images;
    for (const Pose& pose : poses) images.push_back(take(pose));
    return images;
  }

 private:
  Board board_;
  Renderer renderer_;
  std::uint64_t seed_;
  std::uint64_t pictures_ = 0;
};

inline std::vector<LumaView> views_of(const std::vector<GreyImage>& images) {
  std::vector<LumaView> views;
  for (const GreyImage& image : images) views.push_back(image.view());
  return views;
}

}  // namespace roundel::test
