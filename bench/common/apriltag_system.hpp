#pragma once

#include <vector>

#include "bench/common/contender.hpp"

namespace roundel::bench {

// AprilTag 3 (Debian's libapriltag), families 16h5 and 36h11, looking for quads at full resolution.
std::vector<Contender> apriltag_contenders();

// The family 36h11, with quads looked for in every decimate-th pixel of every decimate-th row.
Contender apriltag_contender(int decimate);

}  // namespace roundel::bench
