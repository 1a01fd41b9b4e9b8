#include "tools/board_scene.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "core/necklace.hpp"
#include "simulator/random.hpp"
#include "simulator/visibility.hpp"

namespace roundel {
namespace {

using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;
constexpr double kSheetMargin = 0.4;  // of the spacing, around the outermost cells

Pose marker_pose(const Board& board, int id, const Pose& board_in_camera) {
  const Eigen::Vector2d at = board.centre_of(id);
  return {board_in_camera.to_camera({at.x(), at.y(), 0}), board_in_camera.orientation};
}

// Facing the camera squarely: x right, y up in the picture, z toward the camera.
Eigen::Quaterniond facing() {
  return {0, 1, 0, 0};
}

Pose random_pose(const Board& board, const CameraModel& camera, int view, Random& random) {
  constexpr int kGrid = 3;
  const double tilt = random.uniform(10, 40) * kPi / 180, towards = random.uniform(0, 2 * kPi);
  // Mostly upright, every third time on its side.
  const double turn = random.uniform(-0.3, 0.3) + (view % 3 == 2 ? kPi / 2 : 0);
  // The middle of the board goes to the middle of each part of the picture in turn.
  const auto place = [&](int cell, int side) {
    return (0.2 + 0.6 * (cell + random.uniform(0.2, 0.8)) / kGrid) * side;
  };
  const int cell = (4 + 2 * view) % (kGrid * kGrid);
  const Eigen::Vector2d pixel(place(cell % kGrid, camera.width),
                              place(cell / kGrid, camera.height));
  const double size = std::hypot(board.columns, board.rows) * board.spacing_m;
  const double share = random.uniform(0.35, 0.75);  // of the picture's diagonal
  const double depth = camera.fx * size / (share * std::hypot(camera.width, camera.height));
  const Eigen::Vector2d ray = camera.normalise(pixel).value_or(Eigen::Vector2d(0, 0));
  Pose pose;
  pose.position = depth * Vector3d(ray.x(), ray.y(), 1);
  pose.orientation =
      with_positive_w(Eigen::AngleAxisd(tilt, Vector3d(std::cos(towards), std::sin(towards), 0)) *
                      facing() * Eigen::Quaterniond(Eigen::AngleAxisd(turn, Vector3d::UnitZ())));
  return pose;
}

}  // namespace

Scene board_scene(const Board& board, const Pose& board_in_camera) {
  const NecklaceCode code(board.bits, board.hamming);
  const Imaging colours;
  Scene scene;
  SceneShape sheet;
  sheet.outline = Outline::Rectangle;
  sheet.width_m = (board.columns + 2 * kSheetMargin) * board.spacing_m;
  sheet.height_m = (board.rows + 2 * kSheetMargin) * board.spacing_m;
  sheet.grey = colours.white;
  sheet.pose = board_in_camera;
  scene.clutter.push_back(sheet);
  SceneMarker marker;
  marker.bits = board.bits;
  marker.diameter_m = board.diameter_m;
  marker.plate_ratio = 1.1;  // smaller than a cell
  for (int id = 1; id <= board.count(); ++id) {
    marker.word = code.word(id).value();
    marker.pose = marker_pose(board, id, board_in_camera);
    scene.markers.push_back(marker);
  }
  return scene;
}

FrameTruth board_truth(const Board& board, const CameraModel& camera, const Pose& board_in_camera) {
  constexpr double kMargin = 4;  // pixels, for blur
  FrameTruth truth;
  for (int id = 1; id <= board.count(); ++id) {
    MarkerTruth marker;
    marker.id = id;
    marker.pose = marker_pose(board, id, board_in_camera);
    const auto pixel = camera.project(marker.pose.position);
    marker.u = pixel ? pixel->x() : std::numeric_limits<double>::quiet_NaN();
    marker.v = pixel ? pixel->y() : std::numeric_limits<double>::quiet_NaN();
    marker.visible = inside_image(disc_outline(camera, marker.pose, board.diameter_m / 2),
                                  camera.width, camera.height, kMargin);
    marker.x = board.centre_of(id).x();
    marker.y = board.centre_of(id).y();
    truth.markers.push_back(marker);
  }
  return truth;
}

std::vector<Pose> board_poses(const Board& board, const CameraModel& camera, int count,
                              std::uint64_t seed) {
  constexpr int kTries = 1000;
  std::vector<Pose> poses;
  Random random(seed);
  for (int view = 0; view < count; ++view) {
    bool found = false;
    for (int i = 0; i < kTries && !found; ++i) {
      const Pose pose = random_pose(board, camera, view, random);
      const FrameTruth truth = board_truth(board, camera, pose);
      const auto visible = std::count_if(truth.markers.begin(), truth.markers.end(),
                                         [](const MarkerTruth& m) { return m.visible; });
      found = 3 * visible >= 2 * board.count();
      if (found) poses.push_back(pose);
    }
    if (!found) throw std::invalid_argument("no view of the board fits into this camera's picture");
  }
  return poses;
}

}  // namespace roundel
