#pragma once

#include "bench/accuracy/system.hpp"

namespace roundel::bench {

// Roundel as the daemon runs it, with the default parameters: the detector on single pictures, and
// in continuous experiments also the tracker. `with_code`: WhyCode, otherwise plain WhyCon.
Systems roundel_systems(const Experiment& experiment, bool with_code);

}  // namespace roundel::bench
