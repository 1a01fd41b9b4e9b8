#include "calibration/intrinsic_calibration.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "calibration/bundle_adjustment.hpp"
#include "calibration/free_residuals.hpp"
#include "calibration/intrinsic_refusal.hpp"
#include "calibration/intrinsic_start.hpp"
#include "calibration/projection_uncertainty.hpp"

namespace roundel {
namespace {

// What printers and paper do to a marker's place, before anything is seen, as shares of the
// spacing: some tenths of a millimetre in the plane, and a sheet that bends by millimetres.
const Eigen::Vector3d kOffsetSigma(0.01, 0.01, 0.05);

// Median length of a two-dimensional Gaussian residual of unit deviation.
constexpr double kRayleighMedian = 1.17741;
// Residuals whose deviation is far below that of the points say that there is no noise (in tests).
constexpr double kLeastScale = 0.02;
// Of what points share beside their own noise, until the residuals tell.
constexpr double kFirstFloorPx = 0.01;
constexpr double kRobust = 2.5, kOutlier = 5.0;  // deviations

IntrinsicMask mask(const IntrinsicOptions& options) {
  IntrinsicMask estimated;
  estimated.fill(true);
  estimated[kK3] = options.estimate_k3;
  return estimated;
}

BundleOptions bundle_options(std::span<const BoardView> views, const IntrinsicOptions& options) {
  BundleOptions bundle;
  bundle.estimated = mask(options);
  if (options.exact_board) return bundle;
  for (const BoardView& view : views) {
    for (const BoardPoint& point : view.points) bundle.markers = std::max(bundle.markers, point.id);
  }
  bundle.offset_sigma_m = kOffsetSigma * options.spacing_m;
  return bundle;
}

// Deviation of the whitened residuals, by their median.
double robust_deviation(std::span<const BoardView> views, const BundleState& state) {
  std::vector<double> lengths;
  for (std::size_t i = 0; i < views.size(); ++i) {
    for (const BoardPoint& point : views[i].points)
      lengths.push_back(whitened_residual(point, state, state.poses[i]));
  }
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  return std::max(kLeastScale, *middle / kRayleighMedian);
}

// The same by their squares, given how many of them are free.
double deviation_of(std::span<const BoardView> views, const BundleState& state, double freedom) {
  double sum = 0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    for (const BoardPoint& point : views[i].points)
      sum += std::pow(whitened_residual(point, state, state.poses[i]), 2);
  }
  return std::sqrt(sum / freedom);
}

// Poses of all views under a camera; those that its lens can't explain, under none.
BundleState with_poses(std::span<const BoardView> views, const CameraModel& camera) {
  BundleState state{camera, {}, {}, kFirstFloorPx};
  CameraModel pinhole = camera;
  pinhole.distortion = {};
  for (const BoardView& view : views) {
    auto pose = board_pose(view, camera);
    if (!pose) pose = board_pose(view, pinhole);
    state.poses.push_back(pose.value_or(Pose{{0, 0, 1}, {0, 1, 0, 0}}));
  }
  return state;
}

// From nothing known: several focal lengths are tried, first with the simplest lens; the one that
// explains the middling point best wins.
BundleState first_state(std::span<const BoardView> views, int width, int height) {
  std::vector<double> focals;
  if (const auto focal = focal_from_homographies(views, width, height)) focals.push_back(*focal);
  for (const double share : {0.5, 0.9, 1.6, 3.0}) focals.push_back(share * std::max(width, height));
  BundleState best;
  double best_deviation = std::numeric_limits<double>::infinity();
  for (const double focal : focals) {
    CameraModel camera = guessed_camera(width, height);
    camera.fx = camera.fy = focal;
    BundleOptions options;
    options.max_steps = 15;
    options.estimated[kFx] = options.estimated[kFy] = options.estimated[kK1] = true;
    BundleState state = with_poses(views, camera);
    options.robust_scale = kRobust * robust_deviation(views, state);
    state = adjust(views, state, options).state;
    for (const auto parameter : {kCx, kCy, kK2, kP1, kP2}) options.estimated[parameter] = true;
    options.robust_scale = kRobust * robust_deviation(views, state);
    state = adjust(views, state, options).state;
    const double deviation = robust_deviation(views, state);
    if (deviation < best_deviation) {
      best = state;
      best_deviation = deviation;
    }
  }
  return best;
}

// The views without the points that are off by too much, and without those views of which too
// little is left; the state follows.
std::vector<BoardView> without_outliers(std::span<const BoardView> views, BundleState& state,
                                        double limit) {
  std::vector<BoardView> kept;
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < views.size(); ++i) {
    BoardView view{views[i].picture, {}};
    for (const BoardPoint& point : views[i].points) {
      if (whitened_residual(point, state, state.poses[i]) < limit) view.points.push_back(point);
    }
    if (view.points.size() < kMinBoardPoints) continue;
    kept.push_back(std::move(view));
    poses.push_back(state.poses[i]);
  }
  state.poses = std::move(poses);
  return kept;
}

std::size_t count_points(std::span<const BoardView> views) {
  std::size_t count = 0;
  for (const BoardView& view : views) count += view.points.size();
  return count;
}

std::vector<BoardView> usable(std::span<const BoardView> views, int width, int height) {
  std::vector<BoardView> result;
  for (const BoardView& view : views) {
    if (view.points.size() >= kMinBoardPoints && board_pose(view, guessed_camera(width, height)))
      result.push_back(view);
  }
  return result;
}

// Squared distances in pixels of a view's points from where they should be.
double squares(const BoardView& view, const BundleState& state, const Pose& pose) {
  double sum = 0;
  for (const BoardPoint& point : view.points) {
    if (const auto pixel = board_pixel(state.camera, pose, state.place(point)))
      sum += (*pixel - point.pixel).squaredNorm();
  }
  return sum;
}

// The adjustment without outliers, and what it says about the points' noise.
struct Weighed {
  BundleResult adjusted;  // its covariance is for `deviation`
  double deviation = 1;   // of the whitened residuals
};

// What the points share beside their own noise is known only from what is left over: adjust, look,
// weigh them anew. With wrong weights the stated deviations are wrong, and usually too small.
Weighed adjust_weighed(std::span<const BoardView> views, BundleState state, BundleOptions bundle) {
  constexpr int kRounds = 3;
  const double values = 2 * static_cast<double>(count_points(views));
  bundle.robust_scale = 0;
  Weighed result;
  for (int round = 0; round <= kRounds; ++round) {
    result.adjusted = adjust(views, state, bundle);
    const double freedom = std::max(1.0, values - result.adjusted.unknowns);
    result.deviation = std::sqrt(2 * result.adjusted.data_cost / freedom);
    const double scale = result.deviation / bundle.residual_sigma;
    result.adjusted.covariance *= scale * scale;
    state = result.adjusted.state;
    state.floor_px = noise_floor(free_residuals(views, state, bundle));
    bundle.residual_sigma = std::max(kLeastScale, deviation_of(views, state, freedom));
  }
  return result;
}

void tell_views(std::span<const BoardView> all, std::span<const BoardView> used,
                const BundleState& state, IntrinsicCalibration& result) {
  double sum = 0;
  for (std::size_t i = 0; i < used.size(); ++i) {
    ViewResult view;
    view.picture = used[i].picture;
    view.points = static_cast<int>(used[i].points.size());
    const double squared = squares(used[i], state, state.poses[i]);
    view.error_px = std::sqrt(squared / view.points);
    view.board_in_camera = state.poses[i];
    view.tilt = std::acos(std::clamp(-state.poses[i].normal().z(), -1.0, 1.0));
    for (const BoardView& before : all) {
      if (before.picture == view.picture)
        view.outliers = static_cast<int>(before.points.size()) - view.points;
    }
    sum += squared;
    result.points += view.points;
    result.views.push_back(view);
  }
  result.outliers = static_cast<int>(count_points(all)) - result.points;
  result.error_px = std::sqrt(sum / result.points);
}

}  // namespace

IntrinsicCalibration calibrate_intrinsics(std::span<const BoardView> views, int width, int height,
                                          const IntrinsicOptions& options,
                                          const std::optional<CameraModel>& start) {
  constexpr int kMaxRounds = 8;
  const std::vector<BoardView> all = usable(views, width, height);
  require_views(all, views.size(), width, height);
  BundleState state = start ? with_poses(all, *start) : first_state(all, width, height);

  // Robust first: outliers must not pull the solution that tells them from the others.
  BundleOptions bundle = bundle_options(all, options);
  double deviation = robust_deviation(all, state);
  for (int round = 0; round < kMaxRounds; ++round) {
    bundle.residual_sigma = deviation;
    bundle.robust_scale = kRobust * deviation;
    state = adjust(all, state, bundle).state;
    const double before = std::exchange(deviation, robust_deviation(all, state));
    if (std::abs(deviation - before) < 0.01 * before) break;
  }
  const std::vector<BoardView> used = without_outliers(all, state, kOutlier * deviation);
  require_agreement(used.size(), all.size());

  const Weighed weighed = adjust_weighed(used, state, bundle);
  const BundleResult& adjusted = weighed.adjusted;

  IntrinsicCalibration result;
  result.camera = adjusted.state.camera;
  result.offsets = adjusted.state.offsets;
  result.residual_sigma = weighed.deviation;
  result.floor_px = weighed.deviation * adjusted.state.floor_px;
  result.covariance = adjusted.covariance;
  tell_views(all, used, adjusted.state, result);
  for (const PlaceUncertainty& place : projection_uncertainty(result.camera, result.covariance))
    result.worst_px = std::max(result.worst_px, place.sigma_px);
  require_determined(result);
  return result;
}

}  // namespace roundel
