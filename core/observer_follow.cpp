#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/conic.hpp"
#include "core/observer.hpp"
#include "core/outline.hpp"

namespace roundel {

namespace {

// Half of the width of an edge's profile that is looked at, in blurs, and what the start may be
// off. A pixel tells of the edge as the square of the profile's slope: 0.97 of it lies within that
// many blurs, and errors grow by less than one percent against looking twice as far.
constexpr double kReachBlurs = 1.5, kReachSlack = 0.5;  // pixels
constexpr double kMaxReach = 4.0;

// Standard deviations that the last step of a followed marker may leave undone: at that the error
// grows by one percent, mostly by much less.
constexpr double kSettled = 0.15;

// Beyond that the light has changed, share of the contrast.
constexpr double kSameLight = 0.1;

// More than noise makes of the blur's stretch.
constexpr double kMotionStretch = 0.1;

// The picture bears a followed pose out while its residuals stay as they were, about, and hardly a
// pixel is disbelieved: a bit of another word would be one in twenty.
constexpr double kMaxGrowth = 1.3, kMinTrust = 0.97;

}  // namespace

std::optional<Ellipse> Observer::outline(const Pose& pose) const {
  return camera_ ? outline_of(pose, parameters_.diameter_m / 2, *camera_) : std::nullopt;
}

void Observer::make_room_for(int workers) {
  while (std::ssize(more_fits_) + 1 < workers) more_fits_.emplace_back(response_);
}

bool Observer::move(Pose& pose, const Ellipse& from, const Ellipse& to) const {
  const auto before = camera_->normalise({from.u, from.v});
  const auto now = camera_->normalise({to.u, to.v});
  if (!before || !now) return false;
  pose.position.head<2>() += pose.position.z() * (*now - *before);
  return true;
}

// The light's slope stays where it is while the marker turns beneath it.
PhotometricState Observer::start_from(const PoseHypothesis& last, const Pose& expected) {
  PhotometricState start = *last.state;
  start.pose = expected;
  const Eigen::Vector3d slope =
      expected.orientation.conjugate() *
      (last.pose.orientation * Eigen::Vector3d(start.slope_x, start.slope_y, 0));
  start.slope_x = slope.x();
  start.slope_y = slope.y();
  return start;
}

std::optional<Observation> Observer::follow(const LumaView& frame, const PoseHypothesis& last,
                                            const Expectation& expected, int worker) {
  PhotometricFit& fit = worker == 0 ? fit_ : more_fits_[static_cast<std::size_t>(worker) - 1];
  PhotometricState start = start_from(last, expected.pose);
  const double reach = std::min(kMaxReach, kReachBlurs * start.blur_px + kReachSlack);
  InnerEdges inner;
  if (last.pattern.kind == Pattern::Kind::kCode) inner.low = kCodeInnerRatio;
  const double radius_m = parameters_.diameter_m / 2;
  if (!fit.load(frame, *camera_, expected.ellipse, radius_m, reach, inner)) return std::nullopt;
  PhotometricState lit = start;
  fit.set_levels(expected.levels, lit);
  if (std::abs(lit.contrast - start.contrast) + std::abs(lit.dark - start.dark) >
      kSameLight * start.contrast) {
    start = lit;
  }

  // Some grey levels always: a start that is off shows as residuals at the edges.
  constexpr double kStartDeviation = 0.02;  // share of the contrast
  FitPlan plan;
  // Motion blur changes with every turn and has to be fitted along.
  const bool in_motion = std::hypot(start.stretch_u, start.stretch_d) > kMotionStretch;
  const bool all = in_motion || expected.in_new_light;
  plan.unknowns = all ? kCodeUnknowns : kFollowedUnknowns;
  plan.min_steps = 1;
  plan.max_steps = 4;
  // Where little is left to move, some of the pixels are enough for the first step.
  plan.rough_steps = expected.close ? 0 : 1;
  plan.rough_every = 4;
  plan.settled = kSettled;
  plan.deviation = std::sqrt(last.mean_square) + kStartDeviation * expected.levels.contrast();
  auto fitted = fit.fit(start, last.pattern, edge_look(last.pattern), plan);
  if (!fitted || fitted->trust < kMinTrust) return std::nullopt;
  const double floor = kModelError * expected.levels.contrast();
  if (fitted->mean_square > kMaxGrowth * (last.mean_square + floor * floor)) return std::nullopt;

  // Residuals that are as they were come from parts that disagree as they did.
  fitted->disagreement = last.disagreement;
  fitted->covariance += last.disagreement;
  Observation observation = followed(last.pattern, expected, *fitted);
  observation.lit_anew = all;
  return observation;
}

Observation Observer::followed(const Pattern& pattern, const Expectation& expected,
                               const PhotometricPose& fitted) {
  Observation observation;
  observation.segment.ellipse = expected.ellipse;
  observation.segment.levels = expected.levels;
  observation.coded = pattern.kind == Pattern::Kind::kCode;
  observation.plausible = true;
  observation.followed = true;
  observation.pose_count = 2;
  PoseHypothesis& found = observation.poses[0];
  found.pose = fitted.state.pose;
  found.disagreement = fitted.disagreement;
  found.covariance = fitted.covariance;
  found.pattern = pattern;
  found.state = fitted.state;
  found.mean_square = fitted.mean_square;
  observation.poses[1].pose = mirrored_pose(found.pose);
  observation.poses[1].covariance = found.covariance;
  return observation;
}

}  // namespace roundel
