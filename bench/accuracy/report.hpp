#pragma once

#include <iosfwd>
#include <vector>

#include "bench/accuracy/summary.hpp"

namespace roundel::bench {

void print_table(std::ostream& out, const std::vector<Summary>& summaries);
void write_summary_csv(std::ostream& out, const std::vector<Summary>& summaries);
void write_markdown(std::ostream& out, const std::vector<Experiment>& experiments,
                    const std::vector<Summary>& summaries);

// The worst of each result: all markers that were not found, then the largest normal and position
// errors, `count` of each.
void write_worst_csv(std::ostream& out, const std::vector<Result>& results, std::size_t count);

}  // namespace roundel::bench
