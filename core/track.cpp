#include "core/track.hpp"

#include <algorithm>
#include <cmath>

namespace roundel {

namespace {

// Hypotheses whose normals are closer than this can't be told apart from frame to frame, radians.
constexpr double kSameNormal = 0.03;
// Evidence for a pose fades, because tilting changes both hypotheses; and it has an end.
constexpr double kFading = 0.9, kMaxPoseLogOdds = 20;
constexpr double kVelocityGain = 0.5;

}  // namespace

Ellipse Track::predicted() const {
  Ellipse expected = ellipse;
  expected.u += velocity.x() * frames_since_seen();
  expected.v += velocity.y() * frames_since_seen();
  return expected;
}

void Track::update(const Observation& seen_now, int id_count) {
  const Eigen::Vector2d moved(seen_now.segment.ellipse.u - ellipse.u,
                              seen_now.segment.ellipse.v - ellipse.v);
  if (observation.segment.threshold != 0) {  // not the first frame
    velocity += kVelocityGain * (moved / frames_since_seen() - velocity);
  }
  observation = seen_now;
  ellipse = seen_now.segment.ellipse;
  threshold = seen_now.segment.threshold;
  missed = 0;
  seen = true;
  implausible = seen_now.plausible ? 0 : implausible + 1;
  evidence.add(seen_now.id, seen_now.id_probability, id_count);
  if (seen_now.pose_count == 0) return;

  const auto normal_of = [&](std::size_t i) { return seen_now.poses[i].pose.normal(); };
  const double first_over_second =
      seen_now.poses[0].log_likelihood - seen_now.poses[1].log_likelihood;
  const double between = (normal_of(0) - normal_of(1)).norm();
  if (normal.isZero() || between < kSameNormal) {
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
