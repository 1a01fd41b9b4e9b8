#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "bench/accuracy/summary.hpp"

namespace roundel::bench {

// A figure for a table; `none` for what does not exist.
inline std::string figure(double value, const char* format, const char* none = "-") {
  return std::isfinite(value) ? fmt::format(fmt::runtime(format), value) : none;
}

// Figures that only markers with an x axis have.
inline std::string yaw_figure(const Summary& s, double value, const char* format,
                              const char* none = "-") {
  return s.has_yaw ? figure(value, format, none) : none;
}

// Figures of systems that say how sure they are.
inline std::string sigma_figure(const Summary& s, double value, const char* format,
                                const char* none = "-") {
  return s.has_sigma ? figure(value, format, none) : none;
}

}  // namespace roundel::bench
