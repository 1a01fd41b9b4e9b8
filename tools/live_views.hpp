#pragma once

#include <string>

#include "calibration/view_collector.hpp"

namespace roundel {

struct LiveOptions {
  std::string socket;       // control socket of roundeld
  double time_limit_s = 0;  // then there is what there is
  bool quiet = false;       // no guidance on standard error
};

// Collects views of a board that somebody shows to the camera of a running roundeld, and tells on
// standard error what to show next: until no part, tilt or turn is missing, until the time limit,
// or until Ctrl-C. roundeld only hands out pictures; all the work is done here. Throws
// std::runtime_error if roundeld can't be asked, or its camera sends nothing.
ViewCollector collect_live(const Board& board, const LiveOptions& options);

}  // namespace roundel
