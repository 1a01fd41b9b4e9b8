#pragma once

#include <iosfwd>
#include <vector>

#include "bench/accuracy/summary.hpp"

namespace roundel::bench {

// What Roundel has to reach in the paper's experiments, held against what it reached in this run,
// and whether any peer did better in anything. Only sets that were run.
void write_targets(std::ostream& out, const std::vector<Summary>& summaries);

}  // namespace roundel::bench
