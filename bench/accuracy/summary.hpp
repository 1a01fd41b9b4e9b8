#pragma once

#include <array>
#include <string>
#include <vector>

#include "bench/accuracy/run.hpp"
#include "bench/common/distribution.hpp"

namespace roundel::bench {

// What one system did in one experiment. Shares are of the judged markers, flips of the found ones.
struct Summary {
  std::string experiment, system;
  bool has_yaw = true, has_sigma = false;
  int judged = 0, found = 0, unread = 0, wrong_ids = 0, missed = 0, flips = 0;
  int extra = 0, extra_ids = 0;           // see Verdicts
  int judged_to_75 = 0, found_to_75 = 0;  // seen at most 75 degrees off their normal
  int sure_ids = 0, sure_wrong_ids = 0;   // readings given kSure or more; extra ones count as wrong
  Distribution position_mm, phi, normal;  // of the found markers; radians

  // Honesty of the published sigmas, flips left out: the means over found markers of
  // (error / sigma)^2 by axis (position x, y, z, rotation x, y, z of the camera), 1 when honest;
  // the means of three of them, the sum of all six, and the share of errors within one sigma; and
  // the sigmas' own size.
  std::array<double, 6> axis_honesty{};
  double position_honesty = 0, rotation_honesty = 0, sum_of_squares = 0, within_sigma = 0;
  double mean_sigma_mm = 0;  // of the position: square root of the axes' summed variances

  // Against the Cramer-Rao bound, over the views for which it is known, flips left out: root mean
  // squares of the position error and of its bound, and their squared quotient; medians of phi and
  // of half the rotation's bound.
  double position_rms_mm = 0, bound_rms_mm = 0, efficiency = 0;
  double bound_phi_median = 0;

  double found_share() const { return judged > 0 ? static_cast<double>(found) / judged : 0; }
  double found_share_to_75() const {
    return judged_to_75 > 0 ? static_cast<double>(found_to_75) / judged_to_75 : 0;
  }
  double flip_share() const { return found > 0 ? static_cast<double>(flips) / found : 0; }
};

Summary summarise(const Result& result);

}  // namespace roundel::bench
