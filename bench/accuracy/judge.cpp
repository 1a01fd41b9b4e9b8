#include "bench/accuracy/judge.hpp"

#include <algorithm>
#include <cmath>

#include "bench/common/placement.hpp"

namespace roundel::bench {

namespace {

constexpr double kMinReach = 3;  // pixels

Outcome outcome_of(const Sighting& sighting, int number, const System& system) {
  if (!system.has_yaw() || sighting.number == number % system.id_count()) return Outcome::kFound;
  return sighting.number < 0 ? Outcome::kUnread : Outcome::kWrongId;
}

void measure(const Sighting& sighting, Record& record) {
  record.position_error = sighting.pose.position - record.truth.position;
  const Eigen::AngleAxisd turn(sighting.pose.orientation * record.truth.orientation.conjugate());
  record.rotation_error = turn.angle() * turn.axis();
  record.phi = orientation_error(sighting.pose.orientation, record.truth.orientation);
  const Eigen::Vector3d seen = sighting.pose.normal(), truth = record.truth.normal();
  record.normal_error = std::atan2(seen.cross(truth).norm(), seen.dot(truth));
  record.has_sigma = sighting.has_sigma;
  record.sigma_position = sighting.sigma_position;
  record.sigma_rotation = sighting.sigma_rotation;
  record.ambiguity = sighting.ambiguity;
}

}  // namespace

void judge(const Experiment& experiment, int view, const System& system,
           std::span<const Sighting> sightings, Verdicts& verdicts) {
  const auto& markers = experiment.views[static_cast<std::size_t>(view)].markers;
  struct Match {
    const Sighting* sighting = nullptr;
    double distance = 0;
  };
  std::vector<Eigen::Vector2d> centres;
  for (const PlacedMarker& marker : markers) {
    centres.push_back(experiment.camera.project(marker.pose.position).value());
  }
  std::vector<Match> matches(markers.size());
  for (const Sighting& sighting : sightings) {
    std::size_t nearest = 0;
    double distance = INFINITY;
    for (std::size_t i = 0; i < markers.size(); ++i) {
      const double d = (centres[i] - Eigen::Vector2d(sighting.u, sighting.v)).norm();
      if (d < distance) {
        distance = d;
        nearest = i;
      }
    }
    if (markers.empty()) break;
    const double reach = std::max(
        kMinReach,
        0.25 * short_side_px(experiment.camera, markers[nearest].pose, experiment.diameter_m));
    Match& match = matches[nearest];
    if (distance > reach || match.sighting != nullptr) {
      ++verdicts.extra;
      if (sighting.number >= 0) ++verdicts.extra_ids;
      if (sighting.number >= 0 && sighting.id_probability >= kSure) ++verdicts.extra_sure_ids;
    }
    if (distance > reach) continue;
    if (match.sighting == nullptr || distance < match.distance) match = {&sighting, distance};
  }
  for (std::size_t i = 0; i < markers.size(); ++i) {
    if (!markers[i].judged) continue;
    Record record;
    record.view = view;
    record.number = markers[i].number;
    record.truth = markers[i].pose;
    record.incidence = incidence(record.truth);
    record.short_side_px = short_side_px(experiment.camera, record.truth, experiment.diameter_m);
    if (const Sighting* sighting = matches[i].sighting) {
      record.read = sighting->number;
      record.id_probability = sighting->id_probability;
      record.outcome = outcome_of(*sighting, record.number, system);
      if (record.outcome == Outcome::kFound) measure(*sighting, record);
    }
    verdicts.records.push_back(record);
  }
}

}  // namespace roundel::bench
