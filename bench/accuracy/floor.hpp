#pragma once

#include <iosfwd>

namespace roundel::bench {

// The arena in 2D mode: robots on the floor of an arena that was calibrated from its corner
// markers, placed by the tracker and the map that the daemon uses. Writes a table for readers.
void write_floor(std::ostream& markdown, int frames);

}  // namespace roundel::bench
