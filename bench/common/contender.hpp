#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bench/common/print.hpp"
#include "bench/common/system.hpp"

namespace roundel::bench {

// A kind of print and the systems that read it: they are shown the same pictures. What is made from
// an experiment borrows it.
struct Contender {
  std::string name;
  std::function<Print(const Experiment&)> print;
  std::function<Systems(const Experiment&)> systems;
  bool is_peer() const { return !name.starts_with("roundel"); }
};

// Every contender that was built in, with its most accurate settings; Roundel's are first.
std::vector<Contender> all_contenders();

}  // namespace roundel::bench
