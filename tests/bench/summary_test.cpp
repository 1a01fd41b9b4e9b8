#include "bench/accuracy/summary.hpp"

#include <doctest/doctest.h>

#include <sstream>

#include "bench/accuracy/targets.hpp"
#include "tests/bench/scene.hpp"
#include "tests/random.hpp"

using namespace roundel;
using namespace roundel::bench;

namespace {

Result result_of(const Experiment& experiment, std::vector<Record> records) {
  Result result{&experiment, "roundel", true, {}};
  result.verdicts.records = std::move(records);
  return result;
}

// Errors of so many published sigmas.
Record found(test::Random& random, double sigmas) {
  Record record;
  record.outcome = Outcome::kFound;
  record.has_sigma = true;
  record.sigma_position = {0.001, 0.002, 0.005};
  record.sigma_rotation = {0.01, 0.02, 0.03};
  for (int axis = 0; axis < 3; ++axis) {
    record.position_error[axis] = sigmas * record.sigma_position[axis] * random.gaussian();
    record.rotation_error[axis] = sigmas * record.sigma_rotation[axis] * random.gaussian();
  }
  return record;
}

Summary summary_of(double sigmas) {
  const Experiment experiment = one_marker();
  test::Random random(3);
  std::vector<Record> records;
  for (int i = 0; i < 5000; ++i) records.push_back(found(random, sigmas));
  return summarise(result_of(experiment, records));
}

std::string targets_with(Summary summary) {
  summary.experiment = "arena-7";
  summary.system = "roundel-track";
  summary.found = summary.judged;
  summary.phi.mean = 0.0005;
  summary.position_mm.mean = 0.5;
  std::ostringstream out;
  write_targets(out, {summary});
  return out.str();
}

}  // namespace

TEST_CASE("honest sigmas give six normalised squares that add up to six") {
  const Summary s = summary_of(1);
  CHECK(s.sum_of_squares == doctest::Approx(6).epsilon(0.03));
  CHECK(s.position_honesty == doctest::Approx(1).epsilon(0.05));
  CHECK(s.within_sigma == doctest::Approx(0.683).epsilon(0.02));
  for (const double axis : s.axis_honesty) CHECK(axis == doctest::Approx(1).epsilon(0.1));
}

TEST_CASE("sigmas that are half as large as they should be show") {
  CHECK(summary_of(2).sum_of_squares == doctest::Approx(24).epsilon(0.03));
}

TEST_CASE("a wrong id counts as sure only if it was told with certainty") {
  const Experiment experiment = one_marker();
  Record wrong;
  wrong.outcome = Outcome::kWrongId;
  wrong.read = 4;
  wrong.id_probability = 0.95;
  Record sure = wrong;
  sure.id_probability = 0.999;
  const Summary s = summarise(result_of(experiment, {wrong, sure}));
  CHECK(s.wrong_ids == 2);
  CHECK(s.sure_ids == 1);
  CHECK(s.sure_wrong_ids == 1);
}

TEST_CASE("a target is met by what reaches it and missed by one figure too bad") {
  CHECK(targets_with(summary_of(1)).find("1 of 1 targets are met") != std::string::npos);
  const std::string dishonest = targets_with(summary_of(2));
  CHECK(dishonest.find("0 of 1 targets are met") != std::string::npos);
  CHECK(dishonest.find("**missed**") != std::string::npos);
}
