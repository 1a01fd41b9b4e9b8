#include "simulator/arena_camera.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "simulator/visibility.hpp"

namespace roundel {

namespace {

constexpr double kFocalX = 1452, kFocalY = 1455;  // pixels, for 1920 x 1080
constexpr Distortion kWebcam = {-0.28, 0.09, 0.0006, -0.0009, -0.012};
constexpr double kBorder = 8;  // pixels between the outermost markers and the image's border

bool shows_all(const CameraModel& camera, const ArenaOptions& options,
               const Pose& arena_in_camera) {
  const double plate = 0.5 * options.diameter_m * options.plate_ratio;
  const auto shown = [&](double x, double y, double z) {
    Pose pose = arena_in_camera;
    pose.position = arena_in_camera.to_camera({x, y, z});
    return inside_image(disc_outline(camera, pose, 0.5 * options.diameter_m), camera.width,
                        camera.height, kBorder);
  };
  for (const double share_x : {0.0, 0.5, 1.0}) {
    for (const double share_y : {0.0, 0.5, 1.0}) {
      const double x = share_x * options.length_m, y = share_y * options.width_m;
      if (options.corners && !shown(x, y, 0)) return false;
      if (!shown(std::clamp(x, plate, options.length_m - plate),
                 std::clamp(y, plate, options.width_m - plate), options.max_height_m)) {
        return false;
      }
    }
  }
  return true;
}

}  // namespace

Pose arena_in_ceiling_camera(const ArenaOptions& options) {
  // Looking down, image right = arena x, image up = arena y: half a turn about x.
  const Eigen::Quaterniond down(0, 1, 0, 0);
  const Eigen::Quaterniond tilt(Eigen::AngleAxisd(options.camera_tilt, Eigen::Vector3d::UnitX()));
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(options.camera_turn, Eigen::Vector3d::UnitZ()));
  Pose pose;
  pose.orientation = with_positive_w((turn * tilt * down).normalized());
  // The optical axis meets the floor in the arena's middle.
  const Eigen::Vector3d up = pose.orientation * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d middle(0.5 * options.length_m, 0.5 * options.width_m, 0);
  pose.position =
      Eigen::Vector3d(0, 0, options.camera_height_m / -up.z()) - pose.orientation * middle;
  return pose;
}

CameraModel arena_camera(const ArenaOptions& options, const Pose& arena_in_camera) {
  if (options.camera) return *options.camera;
  CameraModel camera;
  camera.width = options.image_width;
  camera.height = options.image_height;
  camera.cx = 0.5 * (camera.width - 1);
  camera.cy = 0.5 * (camera.height - 1);
  camera.distortion = kWebcam;
  double scale = std::min(options.image_width / 1920.0, options.image_height / 1080.0);
  constexpr int kTries = 120;  // down to a third: a shorter lens than that is no webcam's
  for (int attempt = 0; attempt < kTries; ++attempt, scale *= 0.99) {
    camera.fx = kFocalX * scale;
    camera.fy = kFocalY * scale;
    if (shows_all(camera, options, arena_in_camera)) return camera;
  }
  throw std::invalid_argument(
      "the arena does not fit into the picture; raise camera_height_m, tilt the camera less or "
      "make "
      "the arena smaller");
}

}  // namespace roundel
