// bench_accuracy: the paper's experiments for Roundel and its peers, in one run.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <thread>

#include "bench/accuracy/false_positives.hpp"
#include "bench/accuracy/floor.hpp"
#include "bench/accuracy/paper_experiments.hpp"
#include "bench/accuracy/rank_tests.hpp"
#include "bench/accuracy/reliability.hpp"
#include "bench/accuracy/report.hpp"
#include "bench/accuracy/run.hpp"
#include "bench/accuracy/targets.hpp"

namespace roundel::bench {
namespace {

struct Options {
  std::string out, worst_file, false_folder;
  std::vector<std::string> only, sets;
  bool quick = false, with_sweeps = false, with_reliability = false, with_distractors = false;
  bool no_sets = false, with_floor = false;
  std::size_t worst_count = 20;
  int jobs = 1;
};

constexpr int kQuickThinning = 10;
constexpr int kFloorFrames = 300;
constexpr int kSweepPoses = 200;
constexpr int kReliabilityViews = 80'000;
constexpr int kDistractors = 1500;                  // pictures of a kind
constexpr int kSetBounds = 150, kSweepBounds = 20;  // views whose bound is worked out

template <typename Item>
void keep(std::vector<Item>& items, const std::vector<std::string>& names, const char* what) {
  if (names.empty()) return;
  for (const std::string& name : names) {
    if (std::none_of(items.begin(), items.end(), [&](const Item& i) { return i.name == name; })) {
      std::string known;
      for (const Item& item : items) known += " " + item.name;
      throw std::invalid_argument(fmt::format("no {} '{}'; there are:{}", what, name, known));
    }
  }
  std::erase_if(items, [&](const Item& item) {
    return std::find(names.begin(), names.end(), item.name) == names.end();
  });
}

// Every experiment with every contender, in that order whoever works on it.
std::vector<Result> run_all(const std::vector<Experiment>& experiments,
                            const std::vector<Contender>& contenders, int bounds, int jobs) {
  const std::size_t tasks = experiments.size() * contenders.size();
  std::vector<std::vector<Result>> results(tasks);
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t i = next++; i < tasks; i = next++) {
      const Experiment& experiment = experiments[i / contenders.size()];
      const Contender& contender = contenders[i % contenders.size()];
      results[i] = run(experiment, contender, bounds);
      std::clog << fmt::format("{} {}\n", experiment.name, contender.name);
    }
  };
  {
    std::vector<std::jthread> threads;
    for (int i = 1; i < jobs; ++i) threads.emplace_back(work);
    work();
  }
  std::vector<Result> all;
  for (auto& part : results) std::move(part.begin(), part.end(), std::back_inserter(all));
  return all;
}

std::ofstream open(const std::filesystem::path& path) {
  std::ofstream file(path);
  if (!file) throw std::runtime_error("cannot write " + path.string());
  return file;
}

std::vector<Summary> summarise_all(const std::vector<Result>& results) {
  std::vector<Summary> summaries;
  for (const Result& result : results) summaries.push_back(summarise(result));
  return summaries;
}

void run_sets(const Options& options, const std::vector<Contender>& contenders) {
  std::vector<Experiment> experiments = paper_experiments(options.quick ? kQuickThinning : 1);
  keep(experiments, options.sets, "set");
  const std::vector<Result> results = run_all(
      experiments, contenders, kSetBounds / (options.quick ? kQuickThinning : 1), options.jobs);
  const std::vector<Summary> summaries = summarise_all(results);
  print_table(std::cout, summaries);

  if (!options.worst_file.empty()) {
    auto file = open(options.worst_file);
    write_worst_csv(file, results, options.worst_count);
  }
  if (options.out.empty()) return;
  const std::filesystem::path folder = options.out;
  auto csv = open(folder / "accuracy.csv");
  write_summary_csv(csv, summaries, {});
  auto markdown = open(folder / "accuracy.md");
  write_markdown(markdown, experiments, summaries, options.quick);
  write_targets(markdown, summaries);
  auto rank_csv = open(folder / "rank_tests.csv");
  write_rank_tests(rank_csv, markdown, experiments, results);
}

void run_sweeps(const Options& options, const std::vector<Contender>& contenders) {
  const std::vector<SweepPoint> points = sweeps(kSweepPoses / (options.quick ? kQuickThinning : 1));
  std::vector<Experiment> experiments;
  for (const SweepPoint& point : points) experiments.push_back(point.experiment);
  const std::vector<Result> results = run_all(
      experiments, contenders, kSweepBounds / (options.quick ? kQuickThinning : 1), options.jobs);
  std::vector<const SweepPoint*> point_of_result;
  for (const Result& result : results) {
    point_of_result.push_back(
        &points[static_cast<std::size_t>(result.experiment - experiments.data())]);
  }
  if (options.out.empty()) {
    write_summary_csv(std::cout, summarise_all(results), point_of_result);
    return;
  }
  auto csv = open(std::filesystem::path(options.out) / "sweeps.csv");
  write_summary_csv(csv, summarise_all(results), point_of_result);
}

void run_reliability(const Options& options) {
  const int views = kReliabilityViews / (options.quick ? kQuickThinning : 1);
  if (options.out.empty()) {
    write_reliability(std::cout, std::cout, views, options.jobs);
    return;
  }
  const std::filesystem::path folder = options.out;
  auto csv = open(folder / "reliability.csv");
  auto markdown = open(folder / "reliability.md");
  write_reliability(csv, markdown, views, options.jobs);
}

void run_distractors(const Options& options) {
  const int pictures = kDistractors / (options.quick ? kQuickThinning : 1);
  if (options.out.empty()) {
    write_false_positives(std::cout, pictures, options.false_folder);
    return;
  }
  auto markdown = open(std::filesystem::path(options.out) / "false_markers.md");
  write_false_positives(markdown, pictures, options.false_folder);
}

void run_floor(const Options& options) {
  const int frames = kFloorFrames / (options.quick ? kQuickThinning : 1);
  if (options.out.empty()) {
    write_floor(std::cout, frames);
    return;
  }
  auto markdown = open(std::filesystem::path(options.out) / "arena_2d.md");
  write_floor(markdown, frames);
}

void report(const Options& options) {
  std::vector<Contender> contenders = all_contenders();
  keep(contenders, options.only, "contender");
  if (!options.out.empty()) std::filesystem::create_directories(options.out);
  if (!options.no_sets) run_sets(options, contenders);
  if (options.with_floor) run_floor(options);
  if (options.with_sweeps) run_sweeps(options, contenders);
  if (options.with_reliability) run_reliability(options);
  if (options.with_distractors) run_distractors(options);
}

}  // namespace
}  // namespace roundel::bench

int main(int argc, char** argv) {
  roundel::bench::Options options;
  CLI::App app{"Accuracy of Roundel and its peers in the paper's experiments"};
  app.add_option("--out", options.out,
                 "folder for CSV files and tables; none: only standard output");
  app.add_option("--only", options.only, "contenders to run (default: all)")->delimiter(',');
  app.add_option("--sets", options.sets, "experiments to run (default: all)")->delimiter(',');
  app.add_flag("--quick", options.quick, "a tenth of the poses");
  app.add_flag("--floor", options.with_floor, "the arena in 2D mode, too");
  app.add_flag("--sweeps", options.with_sweeps,
               "vary tilt, distance, noise, blur, gamma and size, too");
  app.add_flag("--reliability", options.with_reliability,
               "hold the probabilities of ids against how often they are right, too");
  app.add_flag("--distractors", options.with_distractors,
               "look for markers in pictures without any, too");
  app.add_option("--false-markers", options.false_folder,
                 "existing folder for some pictures in which one was found, as PGM");
  app.add_flag("--no-sets", options.no_sets, "leave the experiments out");
  app.add_option("--worst", options.worst_file, "CSV file for the worst cases of each set");
  app.add_option("--worst-count", options.worst_count, "how many of each kind (default 20)");
  app.add_option("--jobs,-j", options.jobs, "experiments at a time")->check(CLI::Range(1, 64));
  CLI11_PARSE(app, argc, argv);
  try {
    roundel::bench::report(options);
  } catch (const std::exception& e) {
    std::cerr << "bench_accuracy: " << e.what() << '\n';
    return 1;
  }
  return 0;
}
