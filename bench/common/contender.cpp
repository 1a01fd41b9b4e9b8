#include "bench/common/contender.hpp"

#include <iterator>

#include "bench/common/apriltag_system.hpp"
#include "bench/common/aruco_system.hpp"
#include "bench/common/roundel_system.hpp"

namespace roundel::bench {

std::vector<Contender> all_contenders() {
  std::vector<Contender> all = roundel_contenders();
  [[maybe_unused]] const auto add = [&](std::vector<Contender> some) {
    std::move(some.begin(), some.end(), std::back_inserter(all));
  };
#ifdef ROUNDEL_BENCH_APRILTAG
  add(apriltag_contenders());
#endif
#ifdef ROUNDEL_BENCH_ARUCO
  add(aruco_contenders());
#endif
  return all;
}

}  // namespace roundel::bench
