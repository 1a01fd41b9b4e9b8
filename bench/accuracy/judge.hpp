#pragma once

#include <span>
#include <vector>

#include "bench/common/experiment.hpp"
#include "bench/common/system.hpp"

namespace roundel::bench {

enum class Outcome {
  kFound,    // with the right id (or seen, where markers have none)
  kUnread,   // seen without an id
  kWrongId,  // seen with another marker's id
  kMissed
};

inline constexpr double kFlip = 0.2;  // radians: a normal further off is the wrong one of the two

inline constexpr double kSure = 0.99;  // probability of an id from which on it has to be right

// How one judged marker of one view was seen by one system.
struct Record {
  int view = 0, number = 0;
  Outcome outcome = Outcome::kMissed;
  int read = -1;  // the number read
  double id_probability = 0;
  Pose truth;
  double incidence = 0;      // radians
  double short_side_px = 0;  // of the outer outline

  // Of a found marker:
  Eigen::Vector3d position_error = Eigen::Vector3d::Zero();  // metres, camera axes
  Eigen::Vector3d rotation_error = Eigen::Vector3d::Zero();  // radians, about the camera axes
  double phi = 0;                                            // arccos |q1 . q2|
  double normal_error = 0;                                   // radians
  bool flipped() const { return normal_error > kFlip; }
  bool has_sigma = false;
  Eigen::Vector3d sigma_position = Eigen::Vector3d::Zero();
  Eigen::Vector3d sigma_rotation = Eigen::Vector3d::Zero();
  double ambiguity = 0;

  // Cramer-Rao bound of this view: square root of the axes' summed variances; negative where it was
  // not worked out.
  double bound_position = -1, bound_rotation = -1;  // metres; radians
  bool has_bound() const { return bound_position >= 0; }
};

struct Verdicts {
  std::vector<Record> records;
  int extra = 0;           // sightings where there is no marker, or the second of one marker
  int extra_ids = 0;       // of them those with an id
  int extra_sure_ids = 0;  // of them those that are sure of it (kSure)
};

// Holds what a system saw in a view against the truth. A sighting belongs to the marker whose
// centre is nearest, within half of the marker's shorter radius.
void judge(const Experiment& experiment, int view, const System& system,
           std::span<const Sighting> sightings, Verdicts& verdicts);

}  // namespace roundel::bench
