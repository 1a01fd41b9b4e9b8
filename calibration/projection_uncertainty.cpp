#include "calibration/projection_uncertainty.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "calibration/board_projection.hpp"

namespace roundel {

std::vector<PlaceUncertainty> projection_uncertainty(const CameraModel& camera,
                                                     const IntrinsicMatrix& covariance) {
  constexpr int kColumns = 9, kRows = 7;
  struct Place {
    std::size_t index;
    BoardProjection projection;
  };
  std::vector<PlaceUncertainty> result;
  std::vector<Place> places;
  for (int j = 0; j < kRows; ++j) {
    for (int i = 0; i < kColumns; ++i) {
      PlaceUncertainty place;
      place.pixel = {(camera.width - 1.0) * i / (kColumns - 1),
                     (camera.height - 1.0) * j / (kRows - 1)};
      place.sigma_px = std::numeric_limits<double>::infinity();
      if (const auto normalised = camera.normalise(place.pixel)) {
        // A point of a plane at depth one, which turns with the camera about its centre.
        Pose plane;
        plane.position = {normalised->x(), normalised->y(), 1};
        if (auto projection = project_board_point(camera, plane, {0, 0, 0})) {
          // The arm of the point is zero: its turn about the camera's centre is made by hand.
          for (int axis = 0; axis < 2; ++axis) {
            const Eigen::Vector3d by_point = projection->by_pose.row(axis).head<3>().transpose();
            projection->by_pose.row(axis).tail<3>() = plane.position.cross(by_point).transpose();
          }
          places.push_back({result.size(), *projection});
        }
      }
      result.push_back(place);
    }
  }
  // The turn that explains most of a change of intrinsics: T = -(sum E'E)^-1 sum E'D.
  Eigen::Matrix3d turns = 1e-12 * Eigen::Matrix3d::Identity();
  Eigen::Matrix<double, 3, kIntrinsicParameters> mixed;
  mixed.setZero();
  for (const Place& place : places) {
    const Eigen::Matrix<double, 2, 3> by_turn = place.projection.by_pose.rightCols<3>();
    turns += by_turn.transpose() * by_turn;
    mixed += by_turn.transpose() * place.projection.by_intrinsics;
  }
  const Eigen::Matrix<double, 3, kIntrinsicParameters> turn = turns.ldlt().solve(mixed);
  for (const Place& place : places) {
    const Eigen::Matrix<double, 2, kIntrinsicParameters> change =
        place.projection.by_intrinsics - place.projection.by_pose.rightCols<3>() * turn;
    const Eigen::Matrix2d spread = change * covariance * change.transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(spread, Eigen::EigenvaluesOnly);
    const double worse = solver.eigenvalues()[1];
    if (std::isfinite(worse)) result[place.index].sigma_px = std::sqrt(std::max(0.0, worse));
  }
  return result;
}

}  // namespace roundel
