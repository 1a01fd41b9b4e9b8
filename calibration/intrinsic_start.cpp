#include "calibration/intrinsic_start.hpp"

#include <algorithm>
#include <cmath>

#include "calibration/homography.hpp"

namespace roundel {

CameraModel guessed_camera(int width, int height) {
  constexpr double kFocal = 0.9;  // of the longer side: 58 degrees
  CameraModel camera;
  camera.width = width;
  camera.height = height;
  camera.fx = camera.fy = kFocal * std::max(width, height);
  camera.cx = 0.5 * (width - 1);
  camera.cy = 0.5 * (height - 1);
  return camera;
}

std::optional<double> focal_from_homographies(std::span<const BoardView> views, int width,
                                              int height) {
  const CameraModel guess = guessed_camera(width, height);
  // With w = diag(v, v, 1), v = 1/f^2 in units of the guess, h1'w h2 = 0 and h1'w h1 = h2'w h2: two
  // equations p v + q = 0 a view. Frontal views have small p and q and little say.
  double pp = 0, pq = 0;
  std::vector<PlanePoint> points;
  for (const BoardView& view : views) {
    points.clear();
    for (const BoardPoint& point : view.points)
      points.push_back({point.on_board, guess.from_pixel(point.pixel)});
    auto homography = fit_homography(points);
    if (!homography) continue;
    *homography /= homography->leftCols<2>().norm();
    const Eigen::Vector3d a = homography->col(0), b = homography->col(1);
    const double p1 = a.head<2>().dot(b.head<2>()), q1 = a.z() * b.z();
    const double p2 = a.head<2>().squaredNorm() - b.head<2>().squaredNorm();
    const double q2 = a.z() * a.z() - b.z() * b.z();
    pp += p1 * p1 + p2 * p2;
    pq += p1 * q1 + p2 * q2;
  }
  const double v = -pq / pp;
  if (!(v > 0) || !std::isfinite(v)) return std::nullopt;
  const double focal = guess.fx / std::sqrt(v);
  const double side = std::max(width, height);
  constexpr double kLeast = 0.2, kMost = 20;  // of the longer side; no lens is beyond
  if (focal < kLeast * side || focal > kMost * side) return std::nullopt;
  return focal;
}

std::optional<Pose> board_pose(const BoardView& view, const CameraModel& camera) {
  std::vector<PlanePoint> points;
  for (const BoardPoint& point : view.points) {
    const auto normalised = camera.normalise(point.pixel);
    if (normalised) points.push_back({point.on_board, *normalised});
  }
  const auto homography = fit_homography(points);
  if (!homography) return std::nullopt;
  return pose_from_homography(*homography);
}

}  // namespace roundel
