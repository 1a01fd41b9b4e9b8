#include "calibration/free_residuals.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>

#include "calibration/bundle_equations.hpp"

namespace roundel {
namespace {

// (I - H)^-1/2 for what a point determines of itself, H; both in its own deviations.
Eigen::Matrix2d stretch(const Eigen::Matrix2d& leverage) {
  constexpr double kLeastFreedom = 0.02;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> free(Eigen::Matrix2d::Identity() - leverage);
  const Eigen::Vector2d by = free.eigenvalues().cwiseMax(kLeastFreedom).cwiseSqrt().cwiseInverse();
  return free.eigenvectors() * by.asDiagonal() * free.eigenvectors().transpose();
}

}  // namespace

std::vector<NoisyResidual> free_residuals(std::span<const BoardView> views,
                                          const BundleState& state, const BundleOptions& options) {
  BundleEquations equations;
  if (!equations.assemble(views, state, options)) return {};
  const auto reduced = equations.reduced(0);
  if (!reduced) return {};
  const Eigen::MatrixXd shared_covariance = scaled_inverse(reduced->matrix);
  std::vector<NoisyResidual> result;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const PoseByShared pose_by_shared = equations.pose_by_shared(*reduced, i);
    for (const BoardPoint& point : views[i].points) {
      const auto projection = project_board_point(state.camera, state.poses[i], state.place(point));
      if (!projection) return {};
      // How the projection moves with the shared unknowns, the view's pose following them.
      const Eigen::Matrix<double, 2, Eigen::Dynamic> by_shared =
          projection_by_shared(point, *projection, options) - projection->by_pose * pose_by_shared;
      const Eigen::Matrix2d known =
          by_shared * shared_covariance * by_shared.transpose() +
          projection->by_pose * reduced->poses[i].solve(projection->by_pose.transpose());
      const Eigen::Matrix2d root = state.spread(point).llt().matrixL();
      const Eigen::Matrix2d whitening = root.inverse();
      const Eigen::Matrix2d leverage = whitening * known * whitening.transpose();
      const Eigen::Vector2d residual = point.pixel - projection->pixel;
      result.push_back({root * stretch(leverage) * whitening * residual, point.covariance});
    }
  }
  return result;
}

}  // namespace roundel
