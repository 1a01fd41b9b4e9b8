#include "calibration/board_detector.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "calibration/intrinsic_start.hpp"
#include "core/frame_check.hpp"

namespace roundel {
namespace {

// Markers further from where the rest of the board says belong to something else. Half a marker
// leaves room for a lens that is not known yet, and is well below the distance of two neighbours.
constexpr double kPlaceTolerance = 0.5;  // of the middling marker's diameter

// The board's axes at a marker differ from its own by no more, lens and first guess included.
constexpr double kMaxSkew = 0.5;  // radians

// How parallel markers and board are: paper is not quite flat.
constexpr double kPaperSigma = 0.03;  // radians
// A marker that says otherwise by more than this is not understood well enough to be corrected.
constexpr double kMaxTurn = 0.3;  // radians

// No centre is better than that, whatever a fit says.
constexpr double kLeastPx = 1e-4;

DetectorParameters parameters_of(const Board& board) {
  DetectorParameters parameters;
  parameters.diameter_m = board.diameter_m;
  parameters.bits = board.bits;
  parameters.hamming = board.hamming;
  return parameters;
}

// d(pixel)/d(point in camera).
Eigen::Matrix<double, 2, 3> pixel_slope(const CameraModel& camera, const Eigen::Vector3d& point) {
  const Eigen::Vector2d n = point.head<2>() / point.z();
  Eigen::Matrix<double, 2, 3> slope;
  slope << 1, 0, -n.x(), 0, 1, -n.y();
  const Eigen::Vector2d focal(camera.fx, camera.fy);
  return focal.asDiagonal() * camera.distort_jacobian(n) * slope / point.z();
}

}  // namespace

BoardDetector::BoardDetector(const Board& board, const CameraModel& camera)
    : board_(checked(board)),
      camera_(camera),
      search_(parameters_of(board)),
      observer_(parameters_of(board), camera) {}

BoardSighting BoardDetector::find(const LumaView& frame, int picture) {
  check_frame(frame, camera_);
  BoardSighting sighting;
  sighting.view.picture = picture;
  look(frame, sighting);
  keep_placed(sighting);
  sighting.edge_width_px = edges_.worst();
  return sighting;
}

void BoardDetector::look(const LumaView& frame, BoardSighting& sighting) {
  const DetectorParameters parameters = parameters_of(board_);
  seen_.clear();
  edges_.clear();
  segments_.clear();
  search_.begin(frame);
  search_.search(frame, {0, 0, frame.width - 1, frame.height - 1}, search_.smallest_spacing(),
                 static_cast<std::size_t>(parameters.max_markers), segments_);
  for (const Segment& segment : segments_) {
    const Observation observation = observer_.observe(frame, segment);
    if (observation.id_probability < parameters.min_id_probability || observation.pose_count != 2)
      continue;
    if (!board_.has(observation.id)) {
      ++sighting.foreign;
      continue;
    }
    seen_.push_back(
        {observation.id, 2 * std::sqrt(segment.ellipse.a * segment.ellipse.b), observation.poses});
    edges_.add(frame, segment.ellipse, segment.levels);
  }
  sighting.markers = static_cast<int>(seen_.size());
}

// Whether a marker's x and y axes run in the picture as the board's do at its place.
bool BoardDetector::is_aligned(const Seen& seen, const Eigen::Matrix3d& homography) const {
  const Eigen::Vector2d centre = board_.centre_of(seen.id);
  const Pose& pose = seen.poses[0].pose;
  const double step = 0.5 * board_.diameter_m;
  for (int axis = 0; axis < 2; ++axis) {
    const auto from = camera_.project(pose.position);
    const auto to = camera_.project(pose.to_camera(step * Eigen::Vector3d::Unit(axis)));
    if (!from || !to) return false;
    const Eigen::Vector2d own = (*to - *from).normalized();
    const Eigen::Vector2d along = apply(homography, centre + step * Eigen::Vector2d::Unit(axis));
    if (!(own.dot((along - apply(homography, centre)).normalized()) > std::cos(kMaxSkew)))
      return false;
  }
  return true;
}

// Which of the markers lie as on the board. Places alone do not tell: the ids of a board with other
// columns lie on a skewed grid.
std::vector<bool> BoardDetector::correctly_placed(std::span<const PlanePoint> points,
                                                  double tolerance_px) const {
  std::vector<bool> placed = consensus(points, tolerance_px);
  std::vector<PlanePoint> agreeing;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (placed[i]) agreeing.push_back(points[i]);
  }
  const auto homography = fit_homography(agreeing);
  if (!homography) return std::vector<bool>(points.size(), false);
  for (std::size_t i = 0; i < points.size(); ++i)
    placed[i] = placed[i] && is_aligned(seen_[i], *homography);
  return placed;
}

// Fills the view with the markers that lie as on the board.
void BoardDetector::keep_placed(BoardSighting& sighting) {
  if (seen_.size() < kMinBoardPoints) return;
  std::vector<PlanePoint> points;
  std::vector<double> diameters;
  for (const Seen& seen : seen_) {
    points.push_back({board_.centre_of(seen.id), point_of(seen, seen.poses[0]).pixel});
    diameters.push_back(seen.diameter_px);
  }
  const auto middle = diameters.begin() + static_cast<std::ptrdiff_t>(diameters.size() / 2);
  std::nth_element(diameters.begin(), middle, diameters.end());
  const std::vector<bool> placed = correctly_placed(points, kPlaceTolerance * *middle);

  std::vector<Seen> kept;
  std::set<int> ids;
  for (std::size_t i = 0; i < seen_.size(); ++i) {
    if (placed[i] && ids.insert(seen_[i].id).second) kept.push_back(seen_[i]);
  }
  sighting.misplaced = static_cast<int>(seen_.size() - kept.size());
  if (kept.size() < kMinBoardPoints) return;

  // The board's pose from all markers tells each of them how it is tilted, far better than it knows
  // by itself; that moves the centres a little, and with them the pose.
  constexpr int kRounds = 2;
  BoardView view{sighting.view.picture, {}};
  for (const Seen& seen : kept) view.points.push_back(point_of(seen, seen.poses[0]));
  for (int round = 0; round < kRounds; ++round) {
    const auto pose = board_pose(view, camera_);
    if (!pose) return;
    view.points.clear();
    for (const Seen& seen : kept) view.points.push_back(point_of(seen, with_board(seen, *pose)));
  }
  sighting.view = std::move(view);
}

// The marker's pose that agrees better with the board's, corrected by what the board's tilt says:
// the mean of the marker's position, given its orientation.
PoseHypothesis BoardDetector::with_board(const Seen& seen, const Pose& board_in_camera) const {
  const Eigen::Vector3d normal = board_in_camera.normal();
  const bool second =
      seen.poses[1].pose.normal().dot(normal) > seen.poses[0].pose.normal().dot(normal);
  PoseHypothesis result = seen.poses[second ? 1 : 0];
  const Eigen::AngleAxisd turn(board_in_camera.orientation * result.pose.orientation.conjugate());
  const Eigen::Vector3d by = std::remainder(turn.angle(), 2 * std::numbers::pi) * turn.axis();
  if (by.norm() > kMaxTurn) return result;
  PoseCovariance& covariance = result.covariance;
  const Eigen::Matrix3d rotation = covariance.bottomRightCorner<3, 3>() +
                                   kPaperSigma * kPaperSigma * Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d gain =
      rotation.ldlt().solve(covariance.bottomLeftCorner<3, 3>()).transpose();
  result.pose.position += gain * by;
  covariance.topLeftCorner<3, 3>() -= gain * covariance.bottomLeftCorner<3, 3>();
  return result;
}

BoardPoint BoardDetector::point_of(const Seen& seen, const PoseHypothesis& hypothesis) const {
  BoardPoint point;
  point.id = seen.id;
  point.on_board = board_.centre_of(seen.id);
  const Eigen::Vector3d& at = hypothesis.pose.position;
  point.pixel = camera_.to_pixel(camera_.distort(at.head<2>() / at.z()));
  const Eigen::Matrix<double, 2, 3> slope = pixel_slope(camera_, at);
  const Eigen::Matrix3d spread = hypothesis.covariance.topLeftCorner<3, 3>();
  point.covariance = slope * spread * slope.transpose();
  point.covariance += kLeastPx * kLeastPx * Eigen::Matrix2d::Identity();
  return point;
}

}  // namespace roundel
