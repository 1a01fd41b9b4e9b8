#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <vector>

#include "calibration/board.hpp"
#include "calibration/intrinsic_view.hpp"
#include "core/camera_model.hpp"
#include "core/pose.hpp"
#include "tests/random.hpp"

namespace roundel::test {

// Centres of markers as a perfect detector would tell them, plus noise: no pictures, so that many
// calibrations can be made in a test.
class SyntheticViews {
 public:
  SyntheticViews(const Board& the_board, const CameraModel& the_camera, std::uint64_t seed)
      : board(the_board),
        camera(the_camera),
        places(static_cast<std::size_t>(board.count())),
        random_(seed) {
    for (int id = 1; id <= board.count(); ++id) {
      const Eigen::Vector2d at = board.centre_of(id);
      places[static_cast<std::size_t>(id) - 1] = {at.x(), at.y(), 0};
    }
  }

  // `tilt` radians towards a direction in the picture, turned in the picture by `turn`, with its
  // middle at a pixel and spanning a share of the picture's diagonal.
  Pose pose(const Eigen::Vector2d& pixel, double tilt, double towards, double turn,
            double share) const {
    const double size = std::hypot(board.columns, board.rows) * board.spacing_m;
    const double depth = camera.fx * size / (share * std::hypot(camera.width, camera.height));
    const Eigen::Vector2d ray = *camera.normalise(pixel);
    const Eigen::Vector3d axis(std::cos(towards), std::sin(towards), 0);
    Pose result;
    result.position = depth * Eigen::Vector3d(ray.x(), ray.y(), 1);
    result.orientation =
        with_positive_w(Eigen::AngleAxisd(tilt, axis) * Eigen::Quaterniond(0, 1, 0, 0) *
                        Eigen::Quaterniond(Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ())));
    return result;
  }

  // All over the picture and tilted to all sides.
  Pose varied_pose(int view) {
    const double u = (0.25 + 0.25 * (view % 3) + random_.uniform(-0.08, 0.08)) * camera.width;
    const double v = (0.25 + 0.25 * (view / 3 % 3) + random_.uniform(-0.08, 0.08)) * camera.height;
    return pose({u, v}, random_.uniform(0.2, 0.7), random_.uniform(0, 2 * std::numbers::pi),
                random_.uniform(-0.3, 0.3) + (view % 3 == 2 ? std::numbers::pi / 2 : 0),
                random_.uniform(0.45, 0.75));
  }

  // The markers inside the picture.
  BoardView view(int picture, const Pose& board_in_camera, double noise_px) {
    BoardView result{picture, {}};
    for (int id = 1; id <= board.count(); ++id) {
      const auto pixel =
          camera.project(board_in_camera.to_camera(places[static_cast<std::size_t>(id) - 1]));
      if (!pixel || pixel->x() < 0 || pixel->y() < 0 || pixel->x() > camera.width - 1 ||
          pixel->y() > camera.height - 1) {
        continue;
      }
      BoardPoint point;
      point.id = id;
      point.on_board = board.centre_of(id);
      point.pixel = *pixel + noise_px * Eigen::Vector2d(random_.gaussian(), random_.gaussian());
      point.covariance = Eigen::Matrix2d::Identity() * 0.02 * 0.02;
      result.points.push_back(point);
    }
    return result;
  }

  std::vector<BoardView> varied_views(int count, double noise_px) {
    std::vector<BoardView> views;
    for (int i = 0; i < count; ++i) views.push_back(view(i, varied_pose(i), noise_px));
    return views;
  }

  Board board;
  CameraModel camera;
  std::vector<Eigen::Vector3d> places;  // of the markers by id - 1, as printed; board frame

 private:
  Random random_;
};

// METHOD.md section 9's webcam, off centre as real ones are.
inline CameraModel webcam() {
  CameraModel camera;
  camera.width = 1920;
  camera.height = 1080;
  camera.fx = 1452;
  camera.fy = 1455;
  camera.cx = 971.3;
  camera.cy = 528.8;
  camera.distortion = {-0.28, 0.09, 0.0006, -0.0009, -0.012};
  return camera;
}

}  // namespace roundel::test
