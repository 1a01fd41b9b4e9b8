#pragma once

#include <vector>

#include "bench/common/contender.hpp"

namespace roundel::bench {

// ArUco 4x4 (Debian's OpenCV), with and without sub-pixel corners, pose by IPPE_SQUARE.
std::vector<Contender> aruco_contenders();

// Without sub-pixel corners, in one thread, to be timed.
Contender aruco_contender();

}  // namespace roundel::bench
