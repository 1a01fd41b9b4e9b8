#include "core/track.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace roundel {

namespace {

// Hypotheses whose normals are closer than this can't be told apart from frame to frame, radians.
constexpr double kSameNormal = 0.03;
// Evidence for a pose fades, because tilting changes both hypotheses; and it has an end.
constexpr double kFading = 0.9, kMaxPoseLogOdds = 20;
// Branches meet where so many standard deviations of a normal lie between them.
constexpr double kMeeting = 3;
// Readings of the light's slope that one more is averaged with, and what is more than noise of it.
constexpr int kLightReadings = 4;
constexpr double kOtherLight = 0.02;  // share a radius
constexpr double kVelocityGain = 0.5, kChangeGain = 0.3;
// What makes a track sure of its pose and of its id.
constexpr double kSurePose = 10, kSureName = 0.9999;
// Faster than that a robot does not turn, radians a frame; a flip of the pose does.
constexpr double kMaxTurn = 0.3;
// Residuals of a marker that looks as it did grow by no more than that, a share of the contrast
// aside.
constexpr double kMaxGrowth = 2.5, kModelError = 0.01;
constexpr int kMaxOtherwise = 30;  // frames

Eigen::Vector3d turn_between(const Pose& before, const Pose& after) {
  const Eigen::AngleAxisd turn(after.orientation * before.orientation.conjugate());
  return std::remainder(turn.angle(), 2 * std::numbers::pi) * turn.axis();
}

// How uncertain the direction of a pose's normal is, radians.
double normal_sigma(const PoseHypothesis& hypothesis) {
  const Eigen::Matrix3d turns = hypothesis.covariance.bottomRightCorner<3, 3>();
  const Eigen::Vector3d normal = hypothesis.pose.normal();
  return std::sqrt(std::max(0.0, turns.trace() - normal.dot(turns * normal)));
}

}  // namespace

Ellipse Track::predicted() const {
  Ellipse expected = ellipse;
  expected.u += velocity.x() * frames_since_seen();
  expected.v += velocity.y() * frames_since_seen();
  return expected;
}

Pose Track::predicted_pose() const {
  Pose pose = observation.poses[static_cast<std::size_t>(pose_index)].pose;
  pose.position += step + change;
  if (const double angle = turn.norm(); angle > 0) {
    pose.orientation =
        Eigen::AngleAxisd(angle, turn / angle) * Eigen::Quaterniond(pose.orientation);
  }
  return pose;
}

bool Track::is_sure_of_pose() const {
  return pose_log_odds >= kSurePose || poses_agree;
}

bool Track::is_sure_of_name(int id_count) const {
  if (missed != 0 || observation.pose_count == 0 || implausible > 0) return false;
  const PoseHypothesis& pose = observation.poses[static_cast<std::size_t>(pose_index)];
  if (!pose.state || pose.pattern.kind == Pattern::Kind::kUnknown) return false;
  if (pose.pattern.kind == Pattern::Kind::kPlain) return true;
  const IdEvidence::Name name = evidence.best(id_count);
  return name.id == observation.id && name.probability >= kSureName;
}

bool Track::looks_as_known(const Observation& seen_now) const {
  const PoseHypothesis& pose = seen_now.poses[0];
  const double floor = kModelError * seen_now.segment.levels.contrast();
  return is_same_print(pose) &&
         pose.mean_square < kMaxGrowth * (known_look->mean_square + floor * floor);
}

bool Track::contradicts(const Observation& seen_now, int id_count) const {
  if (!known_look || seen_now.pose_count == 0) return false;
  if (!looks_as_known(seen_now)) return true;
  if (known_look->pattern.kind == Pattern::Kind::kPlain) return !seen_now.plausible;
  const IdEvidence::Name name = evidence.best(id_count);
  return name.probability >= kSureName && (seen_now.id != name.id || !seen_now.plausible);
}

bool Track::is_same_print(const PoseHypothesis& pose) const {
  return known_look && pose.pattern.kind == known_look->pattern.kind &&
         pose.pattern.word == known_look->pattern.word;
}

void Track::update(const Observation& seen_now, int id_count) {
  const Eigen::Vector2d moved(seen_now.segment.ellipse.u - ellipse.u,
                              seen_now.segment.ellipse.v - ellipse.v);
  velocity += kVelocityGain * (moved / frames_since_seen() - velocity);
  std::optional<Pose> pose_before;
  if (missed <= 1 && observation.pose_count > 0) {
    pose_before = observation.poses[static_cast<std::size_t>(pose_index)].pose;
  }
  observation = seen_now;
  ellipse = seen_now.segment.ellipse;
  missed = 0;
  seen = true;
  // The name that is known already can't be read off anything but the marker, whatever shadows do
  // to the residuals.
  const IdEvidence::Name name = evidence.best(id_count);
  const bool known = name.id > 0 && name.id == seen_now.id && name.probability >= kSureName;
  implausible = seen_now.plausible || known ? 0 : implausible + 1;
  // A picture that bears the known word out says as much for it as a reading.
  evidence.add(seen_now.id, seen_now.id_probability, id_count);
  if (seen_now.pose_count == 0) return;
  weigh_poses(seen_now);
  smooth_light(seen_now);
  const Pose& pose = seen_now.poses[static_cast<std::size_t>(pose_index)].pose;
  // What has looked otherwise for long has changed for good.
  const bool as_known = !known_look || looks_as_known(seen_now);
  otherwise = as_known ? 0 : otherwise + 1;
  if (!seen_now.disturbed && is_sure_of_name(id_count) && (as_known || otherwise > kMaxOtherwise)) {
    known_look = observation.poses[static_cast<std::size_t>(pose_index)];
  }
  surprise_px = seen_now.followed ? seen_now.surprise_px : surprise_px;
  if (pose_before) {
    const Eigen::Vector3d stepped = pose.position - pose_before->position;
    change += kChangeGain * (stepped - step - change);
    step = stepped;
  } else {
    change.setZero();
    step.setZero();
  }
  turn = pose_before ? turn_between(*pose_before, pose) : Eigen::Vector3d::Zero();
  if (turn.norm() > kMaxTurn) {
    turn.setZero();
    change.setZero();
  }
}

// How the light slopes is read only now and then and holds until the next time: a mean of several
// readings errs less than one does.
void Track::smooth_light(const Observation& seen_now) {
  auto& state = observation.poses[static_cast<std::size_t>(pose_index)].state;
  if (!state) return;
  const Eigen::Quaterniond& axes = state->pose.orientation;
  const Eigen::Vector3d read = axes * Eigen::Vector3d(state->slope_x, state->slope_y, 0);
  if (seen_now.lit_anew) {
    if ((read - light_slope_).norm() > kOtherLight) light_readings_ = 0;
    if (light_readings_ < kLightReadings) ++light_readings_;
    light_slope_ += (read - light_slope_) / light_readings_;
  }
  const Eigen::Vector3d slope = axes.conjugate() * light_slope_;
  state->slope_x = slope.x();
  state->slope_y = slope.y();
}

// Which of an observation's poses continues the track, by the evidence of this and earlier frames.
void Track::weigh_poses(const Observation& seen_now) {
  const auto normal_of = [&](std::size_t i) { return seen_now.poses[i].pose.normal(); };
  if (seen_now.followed) {
    pose_index = 0;
    normal = normal_of(0);
    // Where both branches meet, one may leave by the other's side: what was known is forgotten.
    const double between = (normal - normal_of(1)).norm();
    poses_agree = between < kSameNormal;
    if (between < kSameNormal + kMeeting * normal_sigma(seen_now.poses[0])) pose_log_odds = 0;
    return;
  }
  ++weighings;
  const double first_over_second =
      seen_now.poses[0].log_likelihood - seen_now.poses[1].log_likelihood;
  const double between = (normal_of(0) - normal_of(1)).norm();
  poses_agree = between < kSameNormal;
  if (normal.isZero() || poses_agree) {
    pose_index = 0;
    pose_log_odds = std::max(first_over_second, kFading * pose_log_odds);
  } else {
    const bool first_continues =
        (normal_of(0) - normal).squaredNorm() < (normal_of(1) - normal).squaredNorm();
    pose_log_odds =
        kFading * pose_log_odds + (first_continues ? first_over_second : -first_over_second);
    const bool first_wins = first_continues == (pose_log_odds >= 0);
    pose_index = first_wins ? 0 : 1;
    pose_log_odds = std::abs(pose_log_odds);
  }
  pose_log_odds = std::min(pose_log_odds, kMaxPoseLogOdds);
  normal = normal_of(static_cast<std::size_t>(pose_index));
}

}  // namespace roundel
