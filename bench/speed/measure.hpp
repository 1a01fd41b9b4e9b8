#pragma once

#include "bench/common/contender.hpp"
#include "bench/speed/timing.hpp"

namespace roundel::bench {

// Roundel on all views of an experiment: following frames, and every so often the first frame of a
// tracker that knows nothing.
Timings time_roundel(const Experiment& experiment);

// A peer on `looks` of the judged views, evenly picked. Every frame is a first one for it.
Timings time_peer(const Experiment& experiment, const Contender& peer, int looks);

// A picture with no marker in it: the tracker while it has no track.
Timings time_empty(const Experiment& experiment);

// One marker vanishes for ever; then all come back, and `note` tells after how many frames.
Timings time_missing(Experiment experiment);

// The light drops to a quarter from one frame to the next; `note` tells how many tracks went on.
Timings time_light_drop(const Experiment& experiment);

// All markers move to and fro by one and a half diameters from frame to frame.
Timings time_jumps(Experiment experiment);

// Tracking alone, then with the poses handed to the kernel as LCM messages, through the given URL.
Timings time_publishing(const Experiment& experiment, const std::string& lcm_url);

}  // namespace roundel::bench
