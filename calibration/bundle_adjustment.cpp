#include "calibration/bundle_adjustment.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>
#include <optional>

namespace roundel {
namespace {

using PoseMatrix = Eigen::Matrix<double, 6, 6>;
using MixedMatrix = Eigen::Matrix<double, kIntrinsicParameters, 6>;

// Huber's loss of a squared residual, and the weight that it gives the residual's equations.
struct Loss {
  double cost, weight;
};

Loss huber(double squared, double scale) {
  if (scale <= 0 || squared <= scale * scale) return {0.5 * squared, 1};
  const double length = std::sqrt(squared);
  return {scale * (length - 0.5 * scale), scale / length};
}

double prior_weight(const BundleOptions& options) {
  if (options.stretch_sigma <= 0) return 0;
  const double ratio = options.residual_sigma / options.stretch_sigma;
  return ratio * ratio;
}

// Nothing if a point lies behind the camera.
std::optional<double> cost_of(std::span<const BoardView> views, const BundleState& state,
                              const BundleOptions& options) {
  double cost = 0.5 * prior_weight(options) * state.stretch * state.stretch;
  for (std::size_t i = 0; i < views.size(); ++i) {
    for (const BoardPoint& point : views[i].points) {
      const double residual = whitened_residual(point, state.camera, state.stretch, state.poses[i]);
      cost += huber(residual * residual, options.robust_scale).cost;
    }
  }
  if (!std::isfinite(cost)) return std::nullopt;
  return cost;
}

// The normal equations: [A B; B' C] with one block B, C a view, and the right side.
struct Equations {
  IntrinsicMatrix a = IntrinsicMatrix::Zero();
  IntrinsicVector a_side = IntrinsicVector::Zero();
  std::vector<MixedMatrix> b;
  std::vector<PoseMatrix> c;
  std::vector<PoseStep> c_side;
};

bool assemble(std::span<const BoardView> views, const BundleState& state,
              const BundleOptions& options, Equations& equations) {
  equations.a.setZero();
  equations.a_side.setZero();
  equations.b.assign(views.size(), MixedMatrix::Zero());
  equations.c.assign(views.size(), PoseMatrix::Zero());
  equations.c_side.assign(views.size(), PoseStep::Zero());
  for (std::size_t i = 0; i < views.size(); ++i) {
    for (const BoardPoint& point : views[i].points) {
      auto projection =
          project_board_point(state.camera, state.stretch, state.poses[i], point.on_board);
      if (!projection) return false;
      for (int k = 0; k < kIntrinsicParameters; ++k) {
        if (!options.estimated[static_cast<std::size_t>(k)])
          projection->by_intrinsics.col(k).setZero();
      }
      const Eigen::Matrix2d information = point.covariance.inverse();
      const Eigen::Vector2d residual = point.pixel - projection->pixel;
      const double weight =
          huber(residual.dot(information * residual), options.robust_scale).weight;
      const Eigen::Matrix<double, kIntrinsicParameters, 2> a =
          weight * projection->by_intrinsics.transpose() * information;
      const Eigen::Matrix<double, 6, 2> c = weight * projection->by_pose.transpose() * information;
      equations.a += a * projection->by_intrinsics;
      equations.a_side += a * residual;
      equations.b[i] += a * projection->by_pose;
      equations.c[i] += c * projection->by_pose;
      equations.c_side[i] += c * residual;
    }
  }
  equations.a(kStretch, kStretch) += prior_weight(options);
  equations.a_side[kStretch] -= prior_weight(options) * state.stretch;
  for (int k = 0; k < kIntrinsicParameters; ++k) {
    if (!options.estimated[static_cast<std::size_t>(k)]) {
      equations.a(k, k) = 1;
      equations.a_side[k] = 0;
    }
  }
  return true;
}

// The poses eliminated: (A - sum B C^-1 B') x = right side. Nothing if the equations are singular.
struct Reduced {
  IntrinsicMatrix matrix;
  IntrinsicVector side;
  std::vector<Eigen::LDLT<PoseMatrix>> poses;
};

std::optional<Reduced> reduce(const Equations& equations, double damping) {
  Reduced reduced{equations.a, equations.a_side, {}};
  reduced.matrix.diagonal() *= 1 + damping;
  reduced.poses.reserve(equations.c.size());
  for (std::size_t i = 0; i < equations.c.size(); ++i) {
    PoseMatrix c = equations.c[i];
    c.diagonal() *= 1 + damping;
    reduced.poses.emplace_back(c);
    if (!reduced.poses.back().isPositive()) return std::nullopt;
    const Eigen::Matrix<double, 6, kIntrinsicParameters> solved =
        reduced.poses.back().solve(equations.b[i].transpose());
    reduced.matrix -= equations.b[i] * solved;
    reduced.side -= solved.transpose() * equations.c_side[i];
  }
  return reduced;
}

std::optional<BundleState> stepped(const BundleState& state, const Equations& equations,
                                   double damping) {
  const auto reduced = reduce(equations, damping);
  if (!reduced) return std::nullopt;
  const IntrinsicVector change = reduced->matrix.ldlt().solve(reduced->side);
  if (!change.allFinite()) return std::nullopt;
  BundleState next = state;
  const IntrinsicVector parameters = to_vector(state.camera, state.stretch) + change;
  next.camera = to_camera(parameters, state.camera);
  next.stretch = parameters[kStretch];
  if (!(next.camera.fx > 0) || !(next.camera.fy > 0)) return std::nullopt;
  for (std::size_t i = 0; i < next.poses.size(); ++i) {
    const PoseStep step =
        reduced->poses[i].solve(equations.c_side[i] - equations.b[i].transpose() * change);
    if (!step.allFinite()) return std::nullopt;
    next.poses[i] = moved(next.poses[i], step);
  }
  return next;
}

IntrinsicMatrix covariance_of(const Equations& equations, const BundleOptions& options) {
  const auto reduced = reduce(equations, 0);
  if (!reduced) return IntrinsicMatrix::Constant(std::numeric_limits<double>::infinity());
  // Focal lengths and lens coefficients differ by many orders of magnitude: scaled to unit
  // diagonal.
  const IntrinsicVector scale =
      reduced->matrix.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const IntrinsicMatrix scaled = scale.asDiagonal() * reduced->matrix * scale.asDiagonal();
  IntrinsicMatrix covariance =
      scale.asDiagonal() * scaled.ldlt().solve(IntrinsicMatrix::Identity()) * scale.asDiagonal();
  covariance *= options.residual_sigma * options.residual_sigma;
  for (int k = 0; k < kIntrinsicParameters; ++k) {
    if (options.estimated[static_cast<std::size_t>(k)]) continue;
    covariance.row(k).setZero();
    covariance.col(k).setZero();
  }
  return covariance;
}

}  // namespace

double whitened_residual(const BoardPoint& point, const CameraModel& camera, double stretch,
                         const Pose& board_in_camera) {
  const auto pixel = board_pixel(camera, stretch, board_in_camera, point.on_board);
  if (!pixel) return std::numeric_limits<double>::infinity();
  const Eigen::Vector2d residual = point.pixel - *pixel;
  return std::sqrt(residual.dot(point.covariance.inverse() * residual));
}

BundleResult adjust(std::span<const BoardView> views, const BundleState& start,
                    const BundleOptions& options) {
  constexpr double kLeastDamping = 1e-9, kMostDamping = 1e9;
  constexpr double kSettled = 1e-10;  // relative gain of a step
  BundleResult result;
  result.state = start;
  result.cost = cost_of(views, start, options).value_or(std::numeric_limits<double>::infinity());
  Equations equations;
  double damping = 1e-3;
  for (int step = 0; step < options.max_steps && !result.converged; ++step) {
    if (!assemble(views, result.state, options, equations)) break;
    for (; damping <= kMostDamping; damping *= 10) {
      const auto next = stepped(result.state, equations, damping);
      const auto cost = next ? cost_of(views, *next, options) : std::nullopt;
      if (!cost || !(*cost <= result.cost)) continue;
      result.converged = result.cost - *cost <= kSettled * result.cost;
      result.state = *next;
      result.cost = *cost;
      damping = std::max(kLeastDamping, damping / 10);
      break;
    }
    if (damping > kMostDamping) {  // no step in any direction helps: a minimum to the last digit
      result.converged = true;
    }
  }
  if (assemble(views, result.state, options, equations))
    result.covariance = covariance_of(equations, options);
  return result;
}

}  // namespace roundel
