#pragma once

#include <string>
#include <vector>

#include "calibration/arena_calibration.hpp"
#include "config/configuration.hpp"
#include "transport/frame_information.hpp"
#include "transport/route.hpp"

namespace roundel {

// All that decides which poses go where; what somebody asks who reads the log of another's machine.
struct StartUpFacts {
  const Configuration& values;
  const FrameInformation& information;  // of the first frame
  std::string source;
  const ArenaCalibration* arena = nullptr;  // on file; nullptr: none
  Route route = {};                         // to the URL's address
  double lens_written_s = 0;                // seconds since the epoch; 0: the lens has no file
};

// Lines for the log.
std::vector<std::string> start_up_summary(const StartUpFacts& facts);

// "2 days old"; times are seconds since the epoch.
std::string age(double from_s, double now_s);

}  // namespace roundel
