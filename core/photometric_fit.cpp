#include "core/photometric_fit.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/cholesky.hpp"

namespace roundel {

namespace {

constexpr double kPixelVariance = 1 / 12.0;
constexpr double kMinBlur = 0.29;  // the pixel's own width, its root

// Share of an edge's blur that may be a box and is still taken for a Gaussian: wrong by 0.2 % of
// the contrast.
constexpr double kMaxBoxShare = 0.25;
constexpr double kMaxStretch = 0.9;

// What is known before anything is seen, one standard deviation. Weak against any marker that can
// be read; they keep what can't be told apart from running away.
constexpr double kSlopePrior = 0.3;  // of the light, share a radius
constexpr double kStretchPrior = 0.5;
constexpr double kPinned = 1e-4;  // for what this pattern does not show

// Rounding to whole grey levels and the model itself leave some variance.
constexpr double kLeastVariance = 0.25;

// What the model gets wrong of an edge that is all box (corners, curves in a pixel), share of the
// contrast as if it were noise of every pixel. Blur makes the more of it good the more there is.
constexpr double kBoxError = 0.008;

// Residuals beyond so many deviations lose weight, and all of it (glare, what covers the marker).
constexpr double kRobust = 3.0, kOutlier = 8.0;

// That the outer rim and what is inside are cut into, each, to see whether they agree.
constexpr int kParts = 16;

}  // namespace

EdgeLook edge_look(const Pattern& pattern) {
  constexpr double kKnownRatio = 0.01, kSmallShift = 0.02;  // share of the radius; pixels
  EdgeLook look;
  const bool known = pattern.kind == Pattern::Kind::kCode ||
                     (pattern.kind == Pattern::Kind::kPlain && pattern.inner_sigma < kKnownRatio);
  if (!known) look.shift_sigma_px = kSmallShift;
  return look;
}

namespace {

// Variance of the grey levels about the model, that of pixels and what makes them err together.
double variance_of(const PhotometricState& state, double mean_square) {
  const double box = kPixelVariance / (state.blur_px * state.blur_px);
  const double error = kBoxError * box * box * state.contrast;
  return std::max(mean_square, kLeastVariance) + error * error;
}

// What a step leaves undone, in standard deviations of the result. A blurred edge looks alike on
// both sides, so that a Gauss-Newton step by d is wrong only in the third order, by d^3 / 12 in
// blurs; some edges move by more than the mean. A turn out of the plane foreshortens in the second
// order.
struct StepSize {
  double gain;            // square of the step in standard deviations
  double moved_blurs;     // of the edges, root of the mean square
  double foreshortening;  // pixels, beyond what the derivatives tell
  double edge_sigma_px;   // standard deviation of a shift of all edges together
};
double left_by(const StepSize& step) {
  constexpr double kUneven = 3;
  // Mostly another distance looks like it.
  constexpr double kUnlikeDistance = 0.7;
  return std::sqrt(step.gain) * kUneven * step.moved_blurs * step.moved_blurs / 12 +
         kUnlikeDistance * step.foreshortening / step.edge_sigma_px;
}

}  // namespace

struct PhotometricFit::Step {
  Vector change = Vector::Zero();
  double mean_square = 0;        // of the residuals before it
  double mean_square_after = 0;  // to second order
  bool last = false;
  PoseCovariance inverse = PoseCovariance::Zero();  // of the normal matrix, marker axes; when last
  // The same for all unknowns, where parts are weighed: by how much a pull at one of them moves the
  // pose.
  Eigen::Matrix<double, kUnknowns, 6> columns = Eigen::Matrix<double, kUnknowns, 6>::Zero();
};

bool PhotometricFit::load(const LumaView& frame, const CameraModel& camera, const Ellipse& ellipse,
                          double radius_m, double reach_px, const InnerEdges& inner) {
  radius_m_ = radius_m;
  return pixels_.load(frame, camera, response_, ellipse, reach_px, inner);
}

void PhotometricFit::set_levels(const Levels& levels, PhotometricState& state) const {
  state.dark = response_.light(levels.dark);
  state.contrast = response_.light(levels.bright) - state.dark;
}

PhotometricState PhotometricFit::first_guess(const Pose& pose, const Levels& levels,
                                             const Pattern& pattern, const EdgeLook& look) const {
  PhotometricState state;
  state.pose = pose;
  set_levels(levels, state);
  state.blur_px = look.blur_px;
  state.shift_px = look.shift_px;
  state.inner_ratio = pattern.inner_ratio;
  return state;
}

PhotometricModel PhotometricFit::model_of(const PhotometricState& state, const Pattern& pattern,
                                          double deviation) const {
  const Eigen::Matrix3d axes = state.pose.orientation.toRotationMatrix();
  Eigen::Matrix3d to_image;
  to_image << radius_m_ * axes.col(0), radius_m_ * axes.col(1), state.pose.position;
  const Eigen::Matrix3d to_plane = to_image.inverse();
  const Eigen::Vector3d at = to_plane * pixels_.middle().homogeneous();
  const Eigen::Vector3d eye = axes.transpose() * -state.pose.position / radius_m_;
  PhotometricModel m{};
  // Everything is scaled by the depth at the middle, which keeps single precision exact enough.
  const double scale = 1 / at.z();
  const Eigen::Matrix<double, 3, 2> by_pixel = to_plane.leftCols<2>() * pixels_.pixel_slope();
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    m.by_u[k] = static_cast<float>(by_pixel(i, 0) * scale);
    m.by_v[k] = static_cast<float>(by_pixel(i, 1) * scale);
    m.at[k] = static_cast<float>(at[i] * scale);
    m.by_x[k] = static_cast<float>(to_plane(i, 0) * scale);
    m.by_y[k] = static_cast<float>(to_plane(i, 1) * scale);
    m.eye[k] = static_cast<float>(eye[i]);
  }
  m.dark = static_cast<float>(state.dark);
  m.contrast = static_cast<float>(state.contrast);
  m.slope_x = static_cast<float>(state.slope_x);
  m.slope_y = static_cast<float>(state.slope_y);
  m.blur = static_cast<float>(state.blur_px);
  m.shift = static_cast<float>(state.shift_px);
  m.stretch_u = static_cast<float>(state.stretch_u);
  m.stretch_d = static_cast<float>(state.stretch_d);
  const double stretch = std::hypot(state.stretch_u, state.stretch_d);
  m.motion = static_cast<float>(stretch);
  m.boxed = std::max(kPixelVariance / (state.blur_px * state.blur_px),
                     2 * stretch / (1 + stretch)) > kMaxBoxShare;
  const bool coded = pattern.kind == Pattern::Kind::kCode;
  m.inner = static_cast<float>(coded ? kCodeInnerRatio : state.inner_ratio);
  m.halves = coded ? 2 * pattern.bits : 0;
  const auto bright = [&](int half) {
    const int k = (half + m.halves) % m.halves;
    const bool bit = ((pattern.word >> (pattern.bits - 1 - k / 2)) & 1U) != 0;
    return bit == (k % 2 == 0) ? 1U : 0U;
  };
  for (int neighbour = 0; neighbour < 5; ++neighbour) {
    std::uint32_t word = 0;
    for (int k = 0; k < m.halves; ++k) word |= bright(k + neighbour - 2) << k;
    m.colours[static_cast<std::size_t>(neighbour)] = static_cast<std::int32_t>(word);
  }
  m.robust_scale = static_cast<float>(kRobust * deviation);
  m.outlier = static_cast<float>(kOutlier * deviation);
  return m;
}

// Solves the normal equations with what is known beforehand.
template <int kCount>
PhotometricFit::Step PhotometricFit::solve(const PhotometricState& state, const Pattern& pattern,
                                           const EdgeLook& look, const PhotometricSums& sums,
                                           const FitPlan& plan, int taken) const {
  Eigen::Matrix<double, kCount, kCount> normal_matrix;
  Eigen::Matrix<double, kCount, 1> right_side;
  std::size_t at = 0;
  for (int r = 0; r < kCount; ++r) {
    for (int c = 0; c <= r; ++c, ++at) {
      normal_matrix(r, c) = normal_matrix(c, r) = static_cast<double>(sums.normal_matrix[at]);
    }
    right_side[r] = static_cast<double>(sums.right_side[static_cast<std::size_t>(r)]);
  }
  Step step;
  step.mean_square = static_cast<double>(sums.squares / std::max(1.0F, sums.weights));
  const double variance = variance_of(state, step.mean_square);
  const Eigen::Matrix<double, kCount, 1> seen = right_side;
  Eigen::Matrix<double, kCount, 1> known = Eigen::Matrix<double, kCount, 1>::Zero();
  const auto add = [&](int unknown, double difference, double deviation) {
    const double weight = variance / (deviation * deviation);
    known[unknown] = weight;
    normal_matrix(unknown, unknown) += weight;
    right_side[unknown] += weight * difference;
  };
  add(kShift, look.shift_px - state.shift_px, look.shift_sigma_px);
  add(kBlur, std::log(look.blur_px / state.blur_px), std::log(look.blur_factor));
  if (pattern.kind != Pattern::Kind::kCode) add(kTurnZ, 0, kPinned);
  if constexpr (kCount > kFollowedUnknowns) {
    add(kSlopeX, -state.slope_x, kSlopePrior);
    add(kSlopeY, -state.slope_y, kSlopePrior);
    add(kStretchU, -state.stretch_u, kStretchPrior);
    add(kStretchD, -state.stretch_d, kStretchPrior);
  }
  if constexpr (kCount > kCodeUnknowns) {
    const bool plain = pattern.kind == Pattern::Kind::kPlain;
    if (plain) {
      add(kInner, pattern.inner_ratio - state.inner_ratio, pattern.inner_sigma);
    } else {
      add(kInner, 0, kPinned);
    }
  }
  const Cholesky<kCount> solver(normal_matrix);
  step.change.template head<kCount>() = solver.solve(right_side);
  const auto change = step.change.template head<kCount>();
  // What the step takes off the residuals alone, without what was known beforehand.
  const double taken_off = change.dot(2 * seen - right_side + known.cwiseProduct(change));
  step.mean_square_after = std::max(0.0, static_cast<double>(sums.squares) - taken_off) /
                           static_cast<double>(std::max(1.0F, sums.weights));
  const auto shift_squares = static_cast<double>(sums.normal_matrix[kShift * (kShift + 3) / 2]);
  StepSize size{};
  size.gain = std::max(0.0, right_side.dot(change) / variance);
  size.edge_sigma_px = std::sqrt(variance / std::max(shift_squares, 1e-30));
  // The step takes as much off as if all edges were shifted by so many pixels.
  size.moved_blurs =
      std::sqrt(size.gain) * size.edge_sigma_px / state.blur_px + std::abs(step.change[kBlur]);
  const double radius_px =
      radius_m_ /
      (state.pose.position.z() * std::sqrt(std::abs(pixels_.pixel_slope().determinant()) + 1e-30));
  size.foreshortening = radius_px * step.change.segment<2>(kTurnX).squaredNorm() / 2;
  const bool settled = left_by(size) < plan.settled;
  const bool rough_only = plan.rough_steps >= plan.max_steps;
  const int least = rough_only ? plan.min_steps : std::max(plan.min_steps, plan.rough_steps + 1);
  step.last = (settled && taken >= least) || taken >= plan.max_steps;
  if (step.last) {
    step.inverse = solver.template inverse_of_first<6>();
    if (plan.weigh_parts) {
      for (int k = 0; k < 6; ++k) {
        step.columns.col(k).template head<kCount>() =
            solver.solve(Eigen::Matrix<double, kCount, 1>::Unit(k));
      }
    }
  }
  return step;
}

PhotometricState PhotometricFit::advanced(const PhotometricState& state, const Vector& step) const {
  PhotometricState next = state;
  const Eigen::Quaterniond& axes = state.pose.orientation;
  next.pose.position += axes * (radius_m_ * step.segment<3>(kMoveX));
  const Eigen::Vector3d turn = step.segment<3>(kTurnX);
  const double angle = turn.norm();
  if (angle > 0) {
    next.pose.orientation =
        (axes * Eigen::Quaterniond(Eigen::AngleAxisd(angle, turn / angle))).normalized();
  }
  next.dark += step[kDark];
  next.contrast += step[kContrast];
  next.slope_x += step[kSlopeX];
  next.slope_y += step[kSlopeY];
  next.blur_px = std::max(kMinBlur, next.blur_px * std::exp(std::clamp(step[kBlur], -0.7, 0.7)));
  next.shift_px += step[kShift];
  next.stretch_u = std::clamp(next.stretch_u + step[kStretchU], -kMaxStretch, kMaxStretch);
  next.stretch_d = std::clamp(next.stretch_d + step[kStretchD], -kMaxStretch, kMaxStretch);
  const double stretch = std::hypot(next.stretch_u, next.stretch_d);
  if (stretch > kMaxStretch) {  // the variance has to stay positive in every direction
    next.stretch_u *= kMaxStretch / stretch;
    next.stretch_d *= kMaxStretch / stretch;
  }
  next.inner_ratio = std::clamp(next.inner_ratio + step[kInner], 0.2, 0.7);
  return next;
}

// From the marker's own motion in radii to the camera's axes in metres.
PoseCovariance PhotometricFit::to_camera_axes(const PhotometricState& state,
                                              const PoseCovariance& inverse) const {
  const Eigen::Matrix3d axes = state.pose.orientation.toRotationMatrix();
  const Eigen::Matrix3d moved = radius_m_ * axes;
  const auto block = [&](int row, int column) {
    return Eigen::Matrix3d(inverse.block<3, 3>(row, column));
  };
  PoseCovariance in_camera;
  in_camera.block<3, 3>(0, 0) = moved * block(0, 0) * moved.transpose();
  in_camera.block<3, 3>(3, 0) = axes * block(3, 0) * moved.transpose();
  in_camera.block<3, 3>(0, 3) = in_camera.block<3, 3>(3, 0).transpose().eval();
  in_camera.block<3, 3>(3, 3) = axes * block(3, 3) * axes.transpose();
  return in_camera;
}

// Covariance of the pose by how much the parts of the marker disagree about it: what each of them
// pulls at the unknowns, taken to the pose. If pixels erred one by one, that would sum up to the
// normal matrix's inverse.
PoseCovariance PhotometricFit::parts_covariance(const PhotometricModel& model, bool inside,
                                                const Step& step) const {
  PoseCovariance sum = PoseCovariance::Zero();
  const auto add = [&](const PixelColumns& all, auto&& add_pulls) {
    const int blocks = all.count / kPixelBlock;
    for (int part = 0; part < kParts; ++part) {
      const int from = blocks * part / kParts, to = blocks * (part + 1) / kParts;
      if (from == to) continue;
      const int at = from * kPixelBlock, count = (to - from) * kPixelBlock;
      PhotometricSums sums;
      add_pulls(model, PixelColumns{all.x + at, all.y + at, all.grey + at, all.weight + at, count},
                sums, VectorUnit::kBest);
      const auto pull =
          Eigen::Map<const Eigen::Matrix<float, kUnknowns, 1>>(sums.right_side.data());
      const Eigen::Matrix<double, 6, 1> moved = step.columns.transpose() * pull.cast<double>();
      sum += moved * moved.transpose();
    }
  };
  add(pixels_.outer(), add_outer_pulls);
  if (inside) add(pixels_.inner(), add_inner_pulls);
  return sum;
}

std::optional<PhotometricPose> PhotometricFit::fit(const PhotometricState& start,
                                                   const Pattern& pattern, const EdgeLook& look,
                                                   const FitPlan& plan) {
  PhotometricState state = start;
  const bool inside = pattern.kind != Pattern::Kind::kUnknown;
  // Only a code shows the whole of the pose; without one the neutral turn has to be pinned, which
  // the shorter sets of unknowns allow as well.
  const int unknowns = pattern.kind == Pattern::Kind::kCode
                           ? std::min<int>(plan.unknowns, kCodeUnknowns)
                           : kPhotometricUnknowns;
  double deviation = plan.deviation;
  for (int taken = 1;; ++taken) {
    const PhotometricModel model = model_of(state, pattern, deviation);
    PhotometricSums sums;
    PixelColumns outer = pixels_.outer(), inner = pixels_.inner();
    outer.every = inner.every = taken <= plan.rough_steps ? plan.rough_every : 1;
    add_outer_pixels(model, outer, unknowns, sums);
    const float outer_squares = sums.squares, outer_weights = sums.weights;
    if (inside) add_inner_pixels(model, inner, unknowns, sums);
    const Step step = unknowns == kFollowedUnknowns
                          ? solve<kFollowedUnknowns>(state, pattern, look, sums, plan, taken)
                      : unknowns == kCodeUnknowns
                          ? solve<kCodeUnknowns>(state, pattern, look, sums, plan, taken)
                          : solve<kUnknowns>(state, pattern, look, sums, plan, taken);
    if (!step.change.allFinite()) return std::nullopt;
    deviation = std::max(0.5, std::min(std::sqrt(step.mean_square), plan.max_deviation));
    state = advanced(state, step.change);
    // Beyond what a start may be off by nothing explains the pixels any more.
    const Pose& pose = state.pose;
    if ((pose.position - start.pose.position).norm() > 0.3 * start.pose.position.norm() ||
        !(state.contrast > 0) || !(pose.normal().dot(pose.position) < 0)) {
      return std::nullopt;
    }
    if (step.last) {
      PhotometricPose result;
      result.state = state;
      result.state.pose.orientation = with_positive_w(pose.orientation);
      result.mean_square = step.mean_square_after;
      const auto mean = [](float squares, float weights) {
        return static_cast<double>(squares / std::max(1.0F, weights));
      };
      result.outer_square = mean(outer_squares, outer_weights);
      result.inner_square = mean(sums.squares - outer_squares, sums.weights - outer_weights);
      result.inner_pixels = inside ? pixels_.inner_count() : 0;
      result.pixels = pixels_.outer_count() + (inside ? pixels_.inner_count() : 0);
      result.trust = static_cast<double>(sums.weights) * outer.every / result.pixels;
      result.inner_trust = static_cast<double>(sums.weights - outer_weights) * outer.every /
                           std::max(1, result.inner_pixels);
      result.covariance =
          to_camera_axes(state, variance_of(state, step.mean_square_after) * step.inverse);
      if (plan.weigh_parts) {
        const PhotometricModel settled = model_of(state, pattern, deviation);
        result.disagreement = disagreement_beyond_noise(
            to_camera_axes(state, parts_covariance(settled, inside, step)), result.covariance);
        result.covariance += result.disagreement;
      }
      return result;
    }
  }
}

}  // namespace roundel
