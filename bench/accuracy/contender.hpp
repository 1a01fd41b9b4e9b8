#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bench/accuracy/judge.hpp"
#include "bench/accuracy/painter.hpp"
#include "bench/accuracy/system.hpp"

namespace roundel::bench {

// A kind of print and the systems that read it: they are shown the same pictures.
struct Contender {
  std::string name;
  std::function<std::unique_ptr<Painter>(const Experiment&)> painter;
  std::function<Systems(const Experiment&)> systems;
};

// Every contender that was built in; Roundel's are first.
std::vector<Contender> all_contenders();

struct Result {
  const Experiment* experiment = nullptr;
  std::string system;
  bool has_yaw = true;
  Verdicts verdicts;
};

// Shows an experiment to a contender; one result a system.
std::vector<Result> run(const Experiment& experiment, const Contender& contender);

}  // namespace roundel::bench
