#pragma once

#include <iosfwd>
#include <vector>

#include "bench/accuracy/summary.hpp"
#include "bench/accuracy/sweep.hpp"

namespace roundel::bench {

// What came out, for the terminal.
void print_table(std::ostream& out, const std::vector<Summary>& summaries);

// All figures. `sweep_points` is empty, or gives every summary what was varied and its value.
void write_summary_csv(std::ostream& out, const std::vector<Summary>& summaries,
                       const std::vector<const SweepPoint*>& sweep_points);

// Tables for readers, one an experiment.
// `quick`: with few poses, which the table then says.
void write_markdown(std::ostream& out, const std::vector<Experiment>& experiments,
                    const std::vector<Summary>& summaries, bool quick);

// The worst of each result: markers that were not found, then the largest position and normal
// errors, `count` of each.
void write_worst_csv(std::ostream& out, const std::vector<Result>& results, std::size_t count);

}  // namespace roundel::bench
