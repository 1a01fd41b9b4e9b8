#pragma once

#include <iosfwd>

#include "bench/speed/timing.hpp"

namespace roundel::bench {

void write_timings_csv(std::ostream& out, const Timings& timings);

// Tables for readers: the targets, met or missed, then every time and its ratio to Roundel's.
// `quick`: of few frames, which the page then says.
void write_timings_markdown(std::ostream& out, const Timings& timings, bool quick);

}  // namespace roundel::bench
