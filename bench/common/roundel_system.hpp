#pragma once

#include <vector>

#include "bench/common/contender.hpp"

namespace roundel::bench {

// Roundel as the daemon runs it, with the default parameters: WhyCode and plain WhyCon; each the
// detector on single pictures, and in continuous experiments also the tracker.
std::vector<Contender> roundel_contenders();

}  // namespace roundel::bench
