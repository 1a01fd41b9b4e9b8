#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "calibration/bundle_adjustment.hpp"

namespace roundel {

// Huber's loss of a squared residual, and the weight that it gives the residual's equations.
// Scale 0: plain squares.
struct Loss {
  double cost, weight;
};
Loss huber(double squared, double scale);

// The unknowns that all views share: the intrinsics, then three offsets a marker.
Eigen::VectorXd shared_values(const BundleState& state, const BundleOptions& options);
bool is_estimated(Eigen::Index shared, const BundleOptions& options);
// Weights of the shared unknowns' squares beside the whitened residuals'.
Eigen::VectorXd prior_weights(const BundleOptions& options);

// How a point's projection moves with them, its view's pose unchanged.
Eigen::Matrix<double, 2, Eigen::Dynamic> projection_by_shared(const BoardPoint& point,
                                                              const BoardProjection& projection,
                                                              const BundleOptions& options);

// Of a symmetric matrix whose unknowns differ by many orders of magnitude, as focal lengths and
// lens coefficients do.
Eigen::MatrixXd scaled_inverse(const Eigen::MatrixXd& matrix);

using PoseByShared = Eigen::Matrix<double, 6, Eigen::Dynamic>;

// The normal equations of the adjustment: [A B; B' C] with one block B, C a view.
class BundleEquations {
 public:
  // The poses eliminated: (A - sum B C^-1 B') x = right side.
  struct Reduced {
    Eigen::MatrixXd matrix;
    Eigen::VectorXd side;
    std::vector<Eigen::LDLT<Eigen::Matrix<double, 6, 6>>> poses;
  };

  // False if a point lies behind the camera.
  bool assemble(std::span<const BoardView> views, const BundleState& state,
                const BundleOptions& options);

  // With the diagonal grown by a share. Nothing if a view does not determine its pose.
  std::optional<Reduced> reduced(double damping) const;

  // The step of a view's pose that belongs to a step of the shared unknowns.
  PoseStep pose_step(const Reduced& reduced, std::size_t view,
                     const Eigen::VectorXd& shared_step) const;
  // How that pose follows the shared unknowns, with the sign changed.
  PoseByShared pose_by_shared(const Reduced& reduced, std::size_t view) const {
    return reduced.poses[view].solve(b_[view].transpose());
  }

 private:
  void add(const BoardPoint& point, const Eigen::Matrix2d& spread,
           const BoardProjection& projection, std::size_t view, const BundleOptions& options);

  Eigen::MatrixXd a_;
  Eigen::VectorXd a_side_;
  std::vector<Eigen::Matrix<double, Eigen::Dynamic, 6>> b_;
  std::vector<Eigen::Matrix<double, 6, 6>> c_;
  std::vector<PoseStep> c_side_;
};

}  // namespace roundel
