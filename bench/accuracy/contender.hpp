#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bench/accuracy/judge.hpp"
#include "bench/accuracy/print.hpp"
#include "bench/accuracy/system.hpp"

namespace roundel::bench {

// A kind of print and the systems that read it: they are shown the same pictures.
struct Contender {
  std::string name;
  std::function<Print(const Experiment&)> print;
  std::function<Systems(const Experiment&)> systems;
};

// Every contender that was built in; Roundel's are first.
std::vector<Contender> all_contenders();

struct Result {
  const Experiment* experiment = nullptr;
  std::string system;
  bool has_yaw = true;
  Verdicts verdicts;  // records in the order of views and markers, the same for every system
};

// Shows an experiment to a contender; one result a system. The Cramer-Rao bound is worked out for
// at most `bounds` of the judged markers, evenly picked.
std::vector<Result> run(const Experiment& experiment, const Contender& contender, int bounds);

}  // namespace roundel::bench
