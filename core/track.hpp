#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <optional>

#include "core/id_evidence.hpp"
#include "core/observer.hpp"

namespace roundel {

// A marker that is followed from frame to frame.
struct Track {
  std::int64_t number = 0;                             // from 1, never used twice
  Ellipse ellipse;                                     // where it was seen last
  Eigen::Vector2d velocity = Eigen::Vector2d::Zero();  // pixels a frame
  int missed = 0;       // frames since it was seen; 0: seen in this frame
  int implausible = 0;  // frames in a row in which it did not look like a marker inside
  IdEvidence evidence;

  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  // of the pose published last; zero before
  double pose_log_odds = 0;  // for the branch that `normal` belongs to, over the other one
  int weighings = 0;         // frames in which both branches were compared
  bool poses_agree = false;  // both branches were the same when they were last compared
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();    // a frame, rotation vector in camera axes
  Eigen::Vector3d step = Eigen::Vector3d::Zero();    // a frame, metres in camera axes
  Eigen::Vector3d change = Eigen::Vector3d::Zero();  // of the step, a frame: robots drive in curves
  // How far from where the motion of earlier frames led it was when it was last followed, pixels.
  double surprise_px = std::numeric_limits<double>::infinity();

  // How it looked when its name was last beyond doubt.
  std::optional<PoseHypothesis> known_look;
  Observation observation;  // of this frame, when `seen`
  int pose_index = 0;       // which of the observation's poses is held for right
  int otherwise = 0;        // frames in a row in which it did not look as it is known
  bool seen = false;

  // Where the ellipse is expected in the current frame, before it has been seen there.
  Ellipse predicted() const;
  // The pose expected in the current frame, for a track that was seen in the last one.
  Pose predicted_pose() const;
  int frames_since_seen() const { return missed > 1 ? missed : 1; }

  // Whether id, or that it has none, is beyond doubt, so that nothing needs to be read anew.
  bool is_sure_of_name(int id_count) const;
  // Whether an observation is at odds with a name that was beyond doubt: another word was read,
  // none, or nothing that looks like a marker.
  bool contradicts(const Observation& seen_now, int id_count) const;
  // Whether a pose was fitted with the pattern that the track is known by.
  bool is_same_print(const PoseHypothesis& pose) const;
  // The same of which of the two poses is the right one.
  bool is_sure_of_pose() const;

  // Takes over this frame's observation: place, motion, evidence for the id and for one of the
  // poses.
  void update(const Observation& seen_now, int id_count);

 private:
  bool looks_as_known(const Observation& seen_now) const;
  void weigh_poses(const Observation& seen_now);
  void smooth_light(const Observation& seen_now);

  Eigen::Vector3d light_slope_ = Eigen::Vector3d::Zero();  // share a radius, camera axes
  int light_readings_ = 0;
};

}  // namespace roundel
