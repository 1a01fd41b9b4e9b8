#pragma once

#include <iosfwd>

#include "bench/speed/timing.hpp"

namespace roundel::bench {

// Null where there is none.
const Timing* find_timing(const Timings& timings, const std::string& scene,
                          const std::string& system, const std::string& frames, int width,
                          int markers);

// The table of what Roundel has to reach, met or missed. What was not measured in this run is left
// out.
void write_speed_targets(std::ostream& out, const Timings& timings);

}  // namespace roundel::bench
