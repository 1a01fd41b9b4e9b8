#include "bench/accuracy/rank_tests.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <map>
#include <utility>

#include "bench/accuracy/quade.hpp"

namespace roundel::bench {

namespace {

constexpr double kLevel = 0.05;
constexpr const char* kReference = "roundel";

struct Metric {
  const char* name;
  double (*value)(const Record&);
};
constexpr Metric kMetrics[] = {
    {"position", [](const Record& r) { return r.position_error.norm(); }},
    {"orientation", [](const Record& r) { return r.phi; }}};

std::vector<std::vector<double>> blocks_of(const std::vector<const Result*>& systems,
                                           const Metric& metric) {
  std::vector<std::vector<double>> blocks;
  // By view and marker: peers may have been shown a part of the views.
  std::map<std::pair<int, int>, std::vector<double>> found;
  for (const Result* system : systems) {
    for (const Record& record : system->verdicts.records) {
      if (record.outcome != Outcome::kFound) continue;
      found[{record.view, record.number}].push_back(metric.value(record));
    }
  }
  for (auto& [marker, block] : found) {
    if (block.size() == systems.size()) blocks.push_back(std::move(block));
  }
  return blocks;
}

void test(std::ostream& csv, std::ostream& markdown, const Experiment& experiment,
          const std::vector<const Result*>& systems, std::size_t reference, const Metric& metric) {
  const auto blocks = blocks_of(systems, metric);
  if (blocks.size() < 2) return;
  const QuadeResult quade = quade_test(blocks);
  const int comparisons = static_cast<int>(systems.size()) - 1;
  std::string outcome;
  for (std::size_t i = 0; i < systems.size(); ++i) {
    if (i == reference) continue;
    const double p = quade.p_value(reference, i, comparisons);
    const bool better = quade.rank_sums[reference] < quade.rank_sums[i];
    const char* verdict = p >= kLevel ? "no difference" : better ? "better" : "worse";
    fmt::print(csv, "{},{},{},{},{:.1f},{},{:.3g},{}\n", experiment.name, metric.name, quade.blocks,
               quade.treatments, quade.f, systems[i]->system, p, verdict);
    outcome +=
        fmt::format("{}{} than {} (p {})", outcome.empty() ? "" : "; ", verdict, systems[i]->system,
                    p < 1e-12 ? std::string("< 1e-12") : fmt::format("= {:.2g}", p));
  }
  fmt::print(markdown, "| {} | {} | {} | {:.0f} | {} |\n", experiment.name, metric.name,
             quade.blocks, quade.f, outcome);
}

}  // namespace

void write_rank_tests(std::ostream& csv, std::ostream& markdown,
                      const std::vector<Experiment>& experiments,
                      const std::vector<Result>& results) {
  fmt::print(csv, "set,metric,poses,systems,quade_f,against,p_sidak,roundel_is\n");
  fmt::print(markdown,
             "\n## Rank tests\n\nQuade's test over the poses that every system found, pairs with "
             "Sidak's correction (5 % level). Roundel is\n\n| set | error | poses | F | Roundel "
             "is |\n|---|---|--:|--:|---|\n");
  for (const Experiment& experiment : experiments) {
    std::vector<const Result*> systems;
    std::size_t reference = 0;
    for (const Result& result : results) {
      // The tracker saw the same pictures as the detector; it would be Roundel against Roundel.
      if (result.experiment != &experiment || !result.has_yaw ||
          result.system.ends_with("-track")) {
        continue;
      }
      if (result.system == kReference) reference = systems.size();
      systems.push_back(&result);
    }
    if (systems.size() < 2 || systems[reference]->system != kReference) continue;
    for (const Metric& metric : kMetrics) {
      test(csv, markdown, experiment, systems, reference, metric);
    }
  }
}

}  // namespace roundel::bench
