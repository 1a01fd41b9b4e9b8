#include "bench/accuracy/judge.hpp"

#include <doctest/doctest.h>

#include "tests/bench/scene.hpp"

using namespace roundel;
using namespace roundel::bench;

namespace {

class Ideal final : public System {
 public:
  const std::string& name() const override { return name_; }
  int id_count() const override { return 30; }
  std::span<const Sighting> look(const LumaView&) override { return {}; }

 private:
  std::string name_ = "ideal";
};

Sighting truth_of(const Experiment& experiment) {
  const PlacedMarker& marker = experiment.views.front().markers.front();
  const Eigen::Vector2d pixel = experiment.camera.project(marker.pose.position).value();
  return {.number = marker.number, .u = pixel.x(), .v = pixel.y(), .pose = marker.pose};
}

Verdicts judged(const Experiment& experiment, const std::vector<Sighting>& sightings) {
  Verdicts verdicts;
  judge(experiment, 0, Ideal(), sightings, verdicts);
  REQUIRE(verdicts.records.size() == 1);
  return verdicts;
}

}  // namespace

TEST_CASE("the truth is found without error") {
  const Experiment experiment = one_marker();
  const Verdicts verdicts = judged(experiment, {truth_of(experiment)});
  const Record& record = verdicts.records.front();
  CHECK(record.outcome == Outcome::kFound);
  CHECK(record.position_error.norm() == 0);
  CHECK(record.phi < 1e-7);
  CHECK(record.normal_error < 1e-7);
  CHECK(!record.flipped());
  CHECK(verdicts.extra == 0);
}

TEST_CASE("errors are told in camera axes, and phi is half the angle") {
  const Experiment experiment = one_marker();
  Sighting sighting = truth_of(experiment);
  sighting.pose.position += Eigen::Vector3d(0.001, 0.002, -0.003);
  sighting.pose.orientation =
      Eigen::AngleAxisd(0.02, Eigen::Vector3d::UnitX()) * sighting.pose.orientation;
  const Record record = judged(experiment, {sighting}).records.front();
  CHECK(record.position_error.isApprox(Eigen::Vector3d(0.001, 0.002, -0.003), 1e-9));
  CHECK(record.rotation_error.isApprox(Eigen::Vector3d(0.02, 0, 0), 1e-9));
  CHECK(record.phi == doctest::Approx(0.01));
}

TEST_CASE("a normal of the other pose is a flip") {
  const Experiment experiment = one_marker();
  Sighting sighting = truth_of(experiment);
  sighting.pose.orientation = tilted(-0.4, 1, 0.3);
  CHECK(judged(experiment, {sighting}).records.front().flipped());
}

TEST_CASE("no id, a wrong id and nothing at all are told apart") {
  const Experiment experiment = one_marker();
  Sighting sighting = truth_of(experiment);
  CHECK(judged(experiment, {}).records.front().outcome == Outcome::kMissed);
  sighting.number = -1;
  CHECK(judged(experiment, {sighting}).records.front().outcome == Outcome::kUnread);
  sighting.number = 7;
  CHECK(judged(experiment, {sighting}).records.front().outcome == Outcome::kWrongId);
  CHECK(judged(experiment, {sighting}).records.front().read == 7);
}

TEST_CASE("sightings beside a marker and second ones of it are extra") {
  const Experiment experiment = one_marker();
  const Sighting sighting = truth_of(experiment);
  Sighting beside = sighting;
  beside.u += 40;
  const Verdicts verdicts = judged(experiment, {beside, sighting, sighting});
  CHECK(verdicts.records.front().outcome == Outcome::kFound);
  CHECK(verdicts.extra == 2);
}
