#pragma once

#include <vector>

#include "bench/common/contender.hpp"
#include "core/detector_parameters.hpp"

namespace roundel::bench {

// Default parameters, with what the experiment tells: the markers' size and code, and the response
// curve where it is known.
DetectorParameters roundel_parameters(const Experiment& experiment, bool with_code);

// Roundel as the daemon runs it, with the default parameters: WhyCode and plain WhyCon; each the
// detector on single pictures, and in continuous experiments also the tracker.
std::vector<Contender> roundel_contenders();

}  // namespace roundel::bench
