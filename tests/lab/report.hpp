#pragma once

#include <cstdio>
#include <string>

namespace roundel {

// A line of figures in the lab's summary.
inline void report(const std::string& line) {
  std::printf("FIGURE %s\n", line.c_str());
  std::fflush(stdout);
}

}  // namespace roundel
