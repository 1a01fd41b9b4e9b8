#pragma once

#include <vector>

#include "bench/common/contender.hpp"

namespace roundel::bench {

// AprilTag 3 (Debian's libapriltag), families 16h5 and 36h11.
std::vector<Contender> apriltag_contenders();

}  // namespace roundel::bench
