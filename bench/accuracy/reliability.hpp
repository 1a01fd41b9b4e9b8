#pragma once

#include <iosfwd>
#include <string>
#include <vector>

namespace roundel::bench {

// One id that was read, and whether it was that of the marker there.
struct Reading {
  double probability = 0;
  bool right = false;
};

// Readings whose probability lies in [low, high).
struct ReliabilityBin {
  double low = 0, high = 1;
  int count = 0, right = 0;
  double mean_probability = 0;
};

// `count` bins of equal width over [0, 1]; a probability of 1 belongs to the last one.
std::vector<ReliabilityBin> reliability_bins(const std::vector<Reading>& readings, int count);

// Expected calibration error: the mean over readings of |share right - mean probability| of the
// bin.
double expected_calibration_error(const std::vector<ReliabilityBin>& bins);

// Reads markers in pictures from easy to hopeless (size, tilt, noise, blur, motion, contrast),
// `views` in all, and some that wear codes of another length, whose every id is false. Writes the
// diagram's bins as CSV and a summary for readers.
void write_reliability(std::ostream& csv, std::ostream& markdown, int views, int jobs);

}  // namespace roundel::bench
