#include "calibration/bundle_equations.hpp"

#include <Eigen/LU>
#include <cmath>

namespace roundel {
namespace {

using PoseMatrix = Eigen::Matrix<double, 6, 6>;

Eigen::Index shared_count(const BundleOptions& options) {
  return kIntrinsicParameters + 3 * options.markers;
}

}  // namespace

Loss huber(double squared, double scale) {
  if (scale <= 0 || squared <= scale * scale) return {0.5 * squared, 1};
  const double length = std::sqrt(squared);
  return {scale * (length - 0.5 * scale), scale / length};
}

Eigen::VectorXd shared_values(const BundleState& state, const BundleOptions& options) {
  Eigen::VectorXd values = Eigen::VectorXd::Zero(shared_count(options));
  values.head<kIntrinsicParameters>() = to_vector(state.camera);
  const std::size_t count =
      std::min(state.offsets.size(), static_cast<std::size_t>(options.markers));
  for (std::size_t k = 0; k < count; ++k)
    values.segment<3>(kIntrinsicParameters + 3 * static_cast<Eigen::Index>(k)) = state.offsets[k];
  return values;
}

bool is_estimated(Eigen::Index shared, const BundleOptions& options) {
  return shared >= kIntrinsicParameters || options.estimated[static_cast<std::size_t>(shared)];
}

Eigen::VectorXd prior_weights(const BundleOptions& options) {
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(shared_count(options));
  for (Eigen::Index k = kIntrinsicParameters; k < weights.size(); ++k) {
    weights[k] = std::pow(
        options.residual_sigma / options.offset_sigma_m[(k - kIntrinsicParameters) % 3], 2);
  }
  return weights;
}

Eigen::Matrix<double, 2, Eigen::Dynamic> projection_by_shared(const BoardPoint& point,
                                                              const BoardProjection& projection,
                                                              const BundleOptions& options) {
  Eigen::Matrix<double, 2, Eigen::Dynamic> by =
      Eigen::Matrix<double, 2, Eigen::Dynamic>::Zero(2, shared_count(options));
  for (int k = 0; k < kIntrinsicParameters; ++k) {
    if (is_estimated(k, options)) by.col(k) = projection.by_intrinsics.col(k);
  }
  if (point.id <= options.markers) {
    by.middleCols<3>(kIntrinsicParameters + 3 * (static_cast<Eigen::Index>(point.id) - 1)) =
        projection.by_place;
  }
  return by;
}

Eigen::MatrixXd scaled_inverse(const Eigen::MatrixXd& matrix) {
  const Eigen::VectorXd scale = matrix.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * matrix * scale.asDiagonal();
  const auto size = scaled.rows();
  return scale.asDiagonal() * scaled.ldlt().solve(Eigen::MatrixXd::Identity(size, size)) *
         scale.asDiagonal();
}

bool BundleEquations::assemble(std::span<const BoardView> views, const BundleState& state,
                               const BundleOptions& options) {
  const Eigen::Index shared = shared_count(options);
  const Eigen::VectorXd weights = prior_weights(options);
  a_ = weights.asDiagonal();
  a_side_ = -weights.cwiseProduct(shared_values(state, options));
  b_.assign(views.size(), Eigen::Matrix<double, Eigen::Dynamic, 6>::Zero(shared, 6));
  c_.assign(views.size(), PoseMatrix::Zero());
  c_side_.assign(views.size(), PoseStep::Zero());
  for (std::size_t i = 0; i < views.size(); ++i) {
    for (const BoardPoint& point : views[i].points) {
      auto projection = project_board_point(state.camera, state.poses[i], state.place(point));
      if (!projection) return false;
      for (int k = 0; k < kIntrinsicParameters; ++k) {
        if (!is_estimated(k, options)) projection->by_intrinsics.col(k).setZero();
      }
      add(point, state.spread(point), *projection, i, options);
    }
  }
  for (int k = 0; k < kIntrinsicParameters; ++k) {
    if (!is_estimated(k, options)) a_(k, k) = 1;
  }
  return true;
}

void BundleEquations::add(const BoardPoint& point, const Eigen::Matrix2d& spread,
                          const BoardProjection& projection, std::size_t view,
                          const BundleOptions& options) {
  const Eigen::Vector2d residual = point.pixel - projection.pixel;
  Eigen::Matrix2d information = spread.inverse();
  information *= huber(residual.dot(information * residual), options.robust_scale).weight;
  constexpr int kOwn =
      static_cast<int>(kIntrinsicParameters) + 3;  // intrinsics and the marker's own offset
  Eigen::Matrix<double, 2, kOwn> by_shared;
  by_shared << projection.by_intrinsics, projection.by_place;
  const Eigen::Matrix<double, kOwn, 2> weighted = by_shared.transpose() * information;
  const Eigen::Matrix<double, kOwn, kOwn> a = weighted * by_shared;
  const Eigen::Matrix<double, kOwn, 1> a_side = weighted * residual;
  const Eigen::Matrix<double, kOwn, 6> b = weighted * projection.by_pose;
  constexpr int kAll = static_cast<int>(kIntrinsicParameters);
  a_.topLeftCorner<kAll, kAll>() += a.topLeftCorner<kAll, kAll>();
  a_side_.head<kAll>() += a_side.head<kAll>();
  b_[view].topRows<kAll>() += b.topRows<kAll>();
  if (point.id <= options.markers) {
    const Eigen::Index at = kAll + 3 * (static_cast<Eigen::Index>(point.id) - 1);
    a_.block<3, 3>(at, at) += a.bottomRightCorner<3, 3>();
    a_.block<3, kAll>(at, 0) += a.bottomLeftCorner<3, kAll>();
    a_.block<kAll, 3>(0, at) += a.topRightCorner<kAll, 3>();
    a_side_.segment<3>(at) += a_side.tail<3>();
    b_[view].middleRows<3>(at) += b.bottomRows<3>();
  }
  const Eigen::Matrix<double, 6, 2> c = projection.by_pose.transpose() * information;
  c_[view] += c * projection.by_pose;
  c_side_[view] += c * residual;
}

std::optional<BundleEquations::Reduced> BundleEquations::reduced(double damping) const {
  Reduced reduced{a_, a_side_, {}};
  reduced.matrix.diagonal() *= 1 + damping;
  reduced.poses.reserve(c_.size());
  for (std::size_t i = 0; i < c_.size(); ++i) {
    PoseMatrix c = c_[i];
    c.diagonal() *= 1 + damping;
    reduced.poses.emplace_back(c);
    if (!reduced.poses.back().isPositive()) return std::nullopt;
    const Eigen::Matrix<double, 6, Eigen::Dynamic> solved =
        reduced.poses.back().solve(b_[i].transpose());
    reduced.matrix.noalias() -= b_[i] * solved;
    reduced.side -= solved.transpose() * c_side_[i];
  }
  return reduced;
}

PoseStep BundleEquations::pose_step(const Reduced& reduced, std::size_t view,
                                    const Eigen::VectorXd& shared_step) const {
  return reduced.poses[view].solve(c_side_[view] - b_[view].transpose() * shared_step);
}

}  // namespace roundel
