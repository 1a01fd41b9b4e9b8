#include "calibration/bundle_adjustment.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <optional>

#include "calibration/bundle_equations.hpp"

namespace roundel {
namespace {

// The sum of the prior's squares and that of the residuals, halved; nothing if a point lies behind
// the camera.
struct Cost {
  double data = 0, prior = 0;
  double total() const { return data + prior; }
};

std::optional<Cost> cost_of(std::span<const BoardView> views, const BundleState& state,
                            const BundleOptions& options) {
  Cost cost;
  for (std::size_t i = 0; i < views.size(); ++i) {
    for (const BoardPoint& point : views[i].points) {
      const double residual = whitened_residual(point, state, state.poses[i]);
      cost.data += huber(residual * residual, options.robust_scale).cost;
    }
  }
  const Eigen::VectorXd weights = prior_weights(options);
  cost.prior = 0.5 * weights.dot(shared_values(state, options).cwiseAbs2());
  if (!std::isfinite(cost.total())) return std::nullopt;
  return cost;
}

std::optional<BundleState> stepped(const BundleState& state, const BundleEquations& equations,
                                   const BundleOptions& options, double damping) {
  const auto reduced = equations.reduced(damping);
  if (!reduced) return std::nullopt;
  const Eigen::VectorXd change = reduced->matrix.ldlt().solve(reduced->side);
  if (!change.allFinite()) return std::nullopt;
  BundleState next = state;
  const IntrinsicVector parameters = to_vector(state.camera) + change.head<kIntrinsicParameters>();
  next.camera = to_camera(parameters, state.camera);
  if (!(next.camera.fx > 0) || !(next.camera.fy > 0)) return std::nullopt;
  next.offsets.resize(static_cast<std::size_t>(options.markers), Eigen::Vector3d::Zero());
  for (int k = 0; k < options.markers; ++k)
    next.offsets[static_cast<std::size_t>(k)] += change.segment<3>(kIntrinsicParameters + 3 * k);
  for (std::size_t i = 0; i < next.poses.size(); ++i) {
    const PoseStep step = equations.pose_step(*reduced, i, change);
    if (!step.allFinite()) return std::nullopt;
    next.poses[i] = moved(next.poses[i], step);
  }
  return next;
}

// The intrinsics' covariance, and how many unknowns the data determine.
void tell_certainty(const BundleEquations& equations, const BundleOptions& options,
                    std::size_t views, BundleResult& result) {
  const auto reduced = equations.reduced(0);
  if (!reduced) {
    result.covariance.setConstant(std::numeric_limits<double>::infinity());
    return;
  }
  const Eigen::MatrixXd inverse = scaled_inverse(reduced->matrix);
  const Eigen::VectorXd weights = prior_weights(options);
  result.unknowns = 6 * static_cast<double>(views);
  for (Eigen::Index k = 0; k < inverse.rows(); ++k) {
    if (is_estimated(k, options)) result.unknowns += 1 - weights[k] * inverse(k, k);
  }
  result.covariance = inverse.topLeftCorner<kIntrinsicParameters, kIntrinsicParameters>() *
                      (options.residual_sigma * options.residual_sigma);
  for (int k = 0; k < kIntrinsicParameters; ++k) {
    if (is_estimated(k, options)) continue;
    result.covariance.row(k).setZero();
    result.covariance.col(k).setZero();
  }
}

}  // namespace

Eigen::Vector3d BundleState::place(const BoardPoint& point) const {
  Eigen::Vector3d place(point.on_board.x(), point.on_board.y(), 0);
  const auto index = static_cast<std::size_t>(point.id) - 1;
  if (index < offsets.size()) place += offsets[index];
  return place;
}

double whitened_residual(const BoardPoint& point, const BundleState& state,
                         const Pose& board_in_camera) {
  const auto pixel = board_pixel(state.camera, board_in_camera, state.place(point));
  if (!pixel) return std::numeric_limits<double>::infinity();
  const Eigen::Vector2d residual = point.pixel - *pixel;
  return std::sqrt(residual.dot(state.spread(point).inverse() * residual));
}

BundleResult adjust(std::span<const BoardView> views, const BundleState& start,
                    const BundleOptions& options) {
  constexpr double kLeastDamping = 1e-9, kMostDamping = 1e9;
  constexpr double kSettled = 1e-10;  // relative gain of a step
  BundleResult result;
  result.state = start;
  const auto keep_cost = [&result](const Cost& cost) {
    result.cost = cost.total();
    result.data_cost = cost.data;
  };
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  keep_cost(cost_of(views, start, options).value_or(Cost{kInfinite, 0}));
  BundleEquations equations;
  double damping = 1e-3;
  for (int step = 0; step < options.max_steps && !result.converged; ++step) {
    if (!equations.assemble(views, result.state, options)) break;
    while (damping <= kMostDamping) {
      const auto next = stepped(result.state, equations, options, damping);
      const auto cost = next ? cost_of(views, *next, options) : std::nullopt;
      if (!cost || !(cost->total() <= result.cost)) {
        damping *= 10;
        continue;
      }
      result.converged = result.cost - cost->total() <= kSettled * result.cost;
      result.state = *next;
      keep_cost(*cost);
      damping = std::max(kLeastDamping, damping / 10);
      break;
    }
    // No step in any direction helps: a minimum to the last digit.
    if (damping > kMostDamping) result.converged = true;
  }
  if (equations.assemble(views, result.state, options)) {
    tell_certainty(equations, options, views.size(), result);
  }
  return result;
}

}  // namespace roundel
