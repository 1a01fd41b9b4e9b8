#pragma once

#include <iosfwd>
#include <vector>

#include "bench/accuracy/run.hpp"

namespace roundel::bench {

// Whether Roundel's errors are smaller than the peers' beyond chance: Quade's test over the poses
// that all systems of an experiment found, pairs with Roundel's detector by Sidak's correction at
// the 5 % level, for position and orientation. Plain WhyCon is left out: it has neither id nor yaw.
void write_rank_tests(std::ostream& csv, std::ostream& markdown,
                      const std::vector<Experiment>& experiments,
                      const std::vector<Result>& results);

}  // namespace roundel::bench
