#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/observer.hpp"

namespace roundel {

namespace {

constexpr double kReach = 3.0;      // pixels on either side of an edge
constexpr double kSamePlace = 0.5;  // pixels
constexpr int kRounds = 3;

// Residuals at the start, share of the contrast: what is far from the model is left out at once.
constexpr double kStartDeviation = 0.06;
// And from then on: what else they are made of does not count for noise.
constexpr double kMoreDeviation = 0.01;

// So much of a marker, and of its code, has to be seen.
constexpr double kMinTrust = 0.8, kMinInnerTrust = 0.7;
// With so much of it the disturbance has passed.
constexpr double kUndisturbed = 0.97;
// And what is seen has to look like it, share of the contrast.
constexpr double kMaxResidual = 0.1;

// A fit to a part of a marker may run away along what that part does not tell.
constexpr double kMaxShift = 0.25, kMaxTurn = 0.35;  // radii; radians

constexpr double kSureReading = 0.99;

}  // namespace

std::optional<Observation> Observer::follow_disturbed(const LumaView& frame,
                                                      const PoseHypothesis& last,
                                                      const Expectation& expected) {
  const double radius_m = parameters_.diameter_m / 2;
  InnerEdges inner;
  if (last.pattern.kind == Pattern::Kind::kCode) inner.low = kCodeInnerRatio;
  PhotometricState start = start_from(last, expected.pose);
  FitPlan plan;
  plan.unknowns = kCodeUnknowns;
  plan.rough_steps = 0;
  plan.min_steps = 2;
  plan.max_steps = 10;
  plan.deviation = std::sqrt(last.mean_square) + kStartDeviation * start.contrast;
  plan.max_deviation = std::sqrt(last.mean_square) + kMoreDeviation * start.contrast;
  plan.weigh_parts = true;
  std::optional<PhotometricPose> fitted;
  std::optional<ShadowEdge> shadow;
  std::optional<Ellipse> seen;
  // Where it was not where it was expected, a part of its edges lay beyond the pixels looked at.
  Ellipse place = expected.ellipse;
  for (int round = 0; round < kRounds; ++round) {
    if (!fit_.load(frame, *camera_, place, radius_m, kReach, inner)) return std::nullopt;
    shadow = find_shadow_edge(frame, PlaneProjection(start.pose, radius_m, *camera_), response_);
    if (shadow) fit_.relight(*shadow);
    fitted = fit_.fit(start, last.pattern, edge_look(last.pattern), plan);
    if (!fitted) return std::nullopt;
    seen = outline(fitted->state.pose);
    if (!seen) return std::nullopt;
    if (std::hypot(seen->u - place.u, seen->v - place.v) < kSamePlace) break;
    place = *seen;
    start = fitted->state;
  }
  if (fitted->trust < kMinTrust || fitted->inner_trust < kMinInnerTrust) return std::nullopt;
  const PhotometricState& state = fitted->state;
  const double limit = kMaxResidual * state.contrast;
  if (state.contrast < parameters_.min_contrast || fitted->mean_square > limit * limit) {
    return std::nullopt;
  }
  const Eigen::Quaterniond turn = expected.pose.orientation.conjugate() * state.pose.orientation;
  const double turned = 2 * std::asin(std::min(1.0, turn.vec().norm()));
  const double scale = radius_m / expected.ellipse.a;  // metres a pixel
  const double allowed = kMaxShift * radius_m + kReach * scale;
  const Eigen::Vector3d moved = state.pose.position - expected.pose.position;
  if (moved.head<2>().norm() > allowed || turned > kMaxTurn) return std::nullopt;

  Observation observation = followed(last.pattern, expected, *fitted);
  observation.segment.ellipse = *seen;
  observation.disturbed = shadow || fitted->trust < kUndisturbed;
  if (reader_ && observation.coded) {
    const auto reading = reader_->read(frame, PlaneProjection(state.pose, radius_m, *camera_),
                                       expected.ellipse.a, expected.levels);
    if (reading && reading->id > 0 && reading->probability >= kSureReading) {
      observation.id = reading->id;
      observation.id_probability = reading->probability;
    }
  }
  return observation;
}

}  // namespace roundel
