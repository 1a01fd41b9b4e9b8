#pragma once

#include <string>

#include "bench/accuracy/judge.hpp"
#include "bench/common/contender.hpp"

namespace roundel::bench {

struct Result {
  const Experiment* experiment = nullptr;
  std::string system;
  bool has_yaw = true;
  Verdicts verdicts;  // records in the order of views and markers; all of them, or those that peers
                      // are shown
};

// Shows an experiment to a contender; one result a system. The Cramer-Rao bound is worked out for
// at most `bounds` of the judged markers, evenly picked.
std::vector<Result> run(const Experiment& experiment, const Contender& contender, int bounds);

}  // namespace roundel::bench
