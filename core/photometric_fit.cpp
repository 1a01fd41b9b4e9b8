#include "core/photometric_fit.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/lens_patch.hpp"

namespace roundel {

namespace {

constexpr double kInnerLimit = 0.8;  // pixels inside see the inner edges, outside the outer rim
constexpr double kMaxOutside = 0.2;  // of the radius: inside the white margin
constexpr double kReachPx = 3.0;     // beyond some blur widths of an edge nothing is to be learned
constexpr int kMaxPixels = 6000;     // larger markers are thinned out
constexpr double kMinBlur = 0.29;    // the pixel's own width, 1/sqrt(12)

// What is known before anything is seen, one standard deviation. Weak against any marker that can
// be read; they keep what can't be told apart from running away.
constexpr double kSlopePrior = 0.3;  // of the light, share a radius
constexpr double kInnerPrior = 0.1;
constexpr double kPinned = 1e-4;  // for what this pattern does not show

// Where a fit ends; rounding to whole grey levels and the model itself leave some variance.
constexpr double kSettled = 1.0, kLeastVariance = 0.25;

// Residuals beyond so many deviations lose weight, and all of it (glare, what covers the marker).
constexpr double kRobust = 3.0, kOutlier = 8.0;

}  // namespace

void PhotometricFit::Columns::clear() {
  for (auto* column : {&x, &y, &grey, &weight}) column->clear();
  used = 0;
}

void PhotometricFit::Columns::add(double px, double py, double level) {
  x.push_back(static_cast<float>(px));
  y.push_back(static_cast<float>(py));
  grey.push_back(static_cast<float>(level));
  weight.push_back(1);
  ++used;
}

void PhotometricFit::Columns::fill_up() {
  while (x.size() % 8 != 0) {
    x.push_back(x.back());
    y.push_back(y.back());
    grey.push_back(grey.back());
    weight.push_back(0);
  }
}

PixelColumns PhotometricFit::Columns::view() const {
  return {x.data(), y.data(), grey.data(), weight.data(), static_cast<int>(x.size())};
}

bool PhotometricFit::load(const LumaView& frame, const CameraModel& camera, const Ellipse& ellipse,
                          const Levels& levels, double radius_m) {
  radius_m_ = radius_m;
  radius_px_ = std::sqrt(ellipse.a * ellipse.b);
  levels_ = levels;
  const double outside = std::min(kMaxOutside * ellipse.b, kReachPx);
  const double a = ellipse.a + outside, b = ellipse.b + outside;
  const double cosine = std::cos(ellipse.angle), sine = std::sin(ellipse.angle);
  const double half_u = std::hypot(a * cosine, b * sine), half_v = std::hypot(a * sine, b * cosine);
  const auto patch = LensPatch::make(camera, {ellipse.u, ellipse.v}, std::max(half_u, half_v));
  if (!patch) return false;
  middle_ = patch->normalise(0, 0);
  pixel_slope_ = patch->slope();

  const int u0 = std::max(0, static_cast<int>(std::ceil(ellipse.u - half_u)));
  const int u1 = std::min(frame.width - 1, static_cast<int>(std::floor(ellipse.u + half_u)));
  const int v0 = std::max(0, static_cast<int>(std::ceil(ellipse.v - half_v)));
  const int v1 = std::min(frame.height - 1, static_cast<int>(std::floor(ellipse.v + half_v)));
  const double area = std::numbers::pi * a * b;
  const int stride = std::max(1, static_cast<int>(std::lround(std::sqrt(area / kMaxPixels))));
  // Bands around the edges, in shares of the outline's radius; flat pixels tell nothing new.
  const double reach = kReachPx / ellipse.b;
  const double rim_low = std::max(kInnerLimit, 1 - reach), rim_high = 1 + outside / ellipse.b;
  const double inner_low = std::max(0.0, kPlainInnerRatioMin - reach);
  const double inner_high = std::min(kInnerLimit, kCodeOuterRatio + reach);
  outer_.clear();
  inner_.clear();
  for (int v = v0; v <= v1; v += stride) {
    const double dv = v - ellipse.v;
    for (int u = u0; u <= u1; u += stride) {
      const double du = u - ellipse.u;
      const double along_a = (du * cosine + dv * sine) / ellipse.a;
      const double along_b = (dv * cosine - du * sine) / ellipse.b;
      const double square = along_a * along_a + along_b * along_b;
      const bool rim = square >= rim_low * rim_low && square <= rim_high * rim_high;
      const bool inside = square >= inner_low * inner_low && square <= inner_high * inner_high;
      if (!rim && !inside) continue;
      const Eigen::Vector2d n = patch->normalise(du, dv) - middle_;
      (rim ? outer_ : inner_).add(n.x(), n.y(), frame.at(u, v));
    }
  }
  if (outer_.used < 2 * kUnknowns || inner_.used == 0) return false;
  outer_.fill_up();
  inner_.fill_up();
  return true;
}

PhotometricModel PhotometricFit::model_of(const State& state, const Pattern& pattern,
                                          double deviation) const {
  const Eigen::Matrix3d axes = state.pose.orientation.toRotationMatrix();
  Eigen::Matrix3d to_image;
  to_image << radius_m_ * axes.col(0), radius_m_ * axes.col(1), state.pose.position;
  const Eigen::Matrix3d to_plane = to_image.inverse();
  const Eigen::Vector3d at = to_plane * middle_.homogeneous();
  const Eigen::Vector3d eye = axes.transpose() * -state.pose.position / radius_m_;
  PhotometricModel m{};
  // Everything is scaled by the depth at the middle, which keeps single precision exact enough.
  const double scale = 1 / at.z();
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    m.at[k] = static_cast<float>(at[i] * scale);
    m.by_x[k] = static_cast<float>(to_plane(i, 0) * scale);
    m.by_y[k] = static_cast<float>(to_plane(i, 1) * scale);
    m.eye[k] = static_cast<float>(eye[i]);
  }
  m.pixel_slope = {static_cast<float>(pixel_slope_(0, 0)), static_cast<float>(pixel_slope_(0, 1)),
                   static_cast<float>(pixel_slope_(1, 0)), static_cast<float>(pixel_slope_(1, 1))};
  m.dark = static_cast<float>(state.dark);
  m.contrast = static_cast<float>(state.contrast);
  m.slope_x = static_cast<float>(state.slope_x);
  m.slope_y = static_cast<float>(state.slope_y);
  m.blur = static_cast<float>(state.blur);
  m.shift = static_cast<float>(state.shift);
  const bool coded = pattern.kind == Pattern::Kind::kCode;
  m.inner = static_cast<float>(coded ? kCodeInnerRatio : state.inner);
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

void PhotometricFit::add_priors(const State& state, const Pattern& pattern, const EdgeLook& look,
                                double variance, Matrix& normal_matrix, Vector& right_side) const {
  const auto add = [&](int unknown, double difference, double deviation) {
    const double weight = variance / (deviation * deviation);
    normal_matrix(unknown, unknown) += weight;
    right_side[unknown] += weight * difference;
  };
  add(kShift, look.shift_px - state.shift, look.shift_sigma_px);
  add(kBlur, std::log(look.blur_px / state.blur), std::log(look.blur_factor));
  add(kSlopeX, -state.slope_x, kSlopePrior);
  add(kSlopeY, -state.slope_y, kSlopePrior);
  const bool plain = pattern.kind == Pattern::Kind::kPlain;
  add(kInner, pattern.inner_ratio - state.inner, plain ? kInnerPrior : kPinned);
  if (pattern.kind != Pattern::Kind::kCode) add(kTurnZ, 0, kPinned);
}

PhotometricFit::State PhotometricFit::advanced(const State& state, const Vector& step) const {
  State next = state;
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
  next.blur = std::max(kMinBlur, next.blur * std::exp(std::clamp(step[kBlur], -0.7, 0.7)));
  next.shift += step[kShift];
  next.inner = std::clamp(next.inner + step[kInner], 0.2, 0.7);
  return next;
}

// From the marker's own motion in radii to the camera's axes in metres.
PoseCovariance PhotometricFit::covariance_of(const State& state, const Matrix& inverse) const {
  const Eigen::Matrix3d axes = state.pose.orientation.toRotationMatrix();
  PoseCovariance to_camera = PoseCovariance::Zero();
  to_camera.topLeftCorner<3, 3>() = radius_m_ * axes;
  to_camera.bottomRightCorner<3, 3>() = axes;
  return to_camera * inverse.topLeftCorner<6, 6>() * to_camera.transpose();
}

std::optional<PhotometricPose> PhotometricFit::fit(const Pose& start, const Pattern& pattern,
                                                   const EdgeLook& look, int max_steps) {
  State state{start, levels_.dark, levels_.contrast(), 0,
              0,     look.blur_px, look.shift_px,      pattern.inner_ratio};
  double deviation = 0.15 * levels_.contrast();  // of residuals; generous for the first step
  for (int step = 1;; ++step) {
    const PhotometricModel model = model_of(state, pattern, deviation);
    PhotometricSums sums;
    add_outer_pixels(model, outer_.view(), sums);
    if (pattern.kind != Pattern::Kind::kUnknown) add_inner_pixels(model, inner_.view(), sums);
    Matrix normal_matrix;
    Vector right_side;
    std::size_t at = 0;
    for (int r = 0; r < kUnknowns; ++r) {
      for (int c = 0; c <= r; ++c, ++at)
        normal_matrix(r, c) = normal_matrix(c, r) = sums.normal_matrix[at];
      right_side[r] = sums.right_side[static_cast<std::size_t>(r)];
    }
    const double mean_square = sums.squares / std::max(1.0F, sums.weights);
    add_priors(state, pattern, look, std::max(mean_square, 0.1), normal_matrix, right_side);
    const Eigen::LDLT<Matrix> solver(normal_matrix);
    const Vector change = solver.solve(right_side);
    if (!change.allFinite()) return std::nullopt;
    deviation = std::max(0.5, std::sqrt(mean_square));
    state = advanced(state, change);
    // Beyond what a start may be off by nothing explains the pixels any more.
    if ((state.pose.position - start.position).norm() > 0.3 * start.position.norm() ||
        !(state.contrast > 0) || !(state.pose.normal().dot(state.pose.position) < 0)) {
      return std::nullopt;
    }
    // What the step takes off the sum of squares, in units of the residuals' variance: one is a move
    // by a standard deviation, and what is then left to do is of the second order.
    const double gain = right_side.dot(change) / std::max(mean_square, kLeastVariance);
    const bool settled = gain < kSettled;
    if ((settled && step >= 2) || step >= max_steps) {
      PhotometricPose result;
      result.pose = {state.pose.position, with_positive_w(state.pose.orientation)};
      result.mean_square = mean_square;
      result.pixels = outer_.used + (pattern.kind == Pattern::Kind::kUnknown ? 0 : inner_.used);
      result.covariance = covariance_of(state, mean_square * solver.solve(Matrix::Identity()));
      result.levels = {state.dark, state.dark + state.contrast};
      result.blur_px = state.blur;
      result.edge_shift_px = state.shift;
      result.inner_ratio = state.inner;
      return result;
    }
  }
}

}  // namespace roundel
