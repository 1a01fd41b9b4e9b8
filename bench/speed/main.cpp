// bench_speed: the paper's timing experiment for Roundel and its peers, in one run.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>

#include "bench/speed/measure.hpp"
#include "bench/speed/scenes.hpp"
#include "bench/speed/speed_report.hpp"
#ifdef ROUNDEL_BENCH_APRILTAG
#include "bench/common/apriltag_system.hpp"
#endif
#ifdef ROUNDEL_BENCH_ARUCO
#include "bench/common/aruco_system.hpp"
#endif

namespace roundel::bench {
namespace {

struct Options {
  std::string out, lcm_url = "memq://";
  bool quick = false, no_peers = false;
};

std::vector<Contender> peers() {
  std::vector<Contender> all;
#ifdef ROUNDEL_BENCH_APRILTAG
  all.push_back(apriltag_contender(1));
  all.push_back(apriltag_contender(2));
#endif
#ifdef ROUNDEL_BENCH_ARUCO
  all.push_back(aruco_contender());
#endif
  return all;
}

Timings measure_all(const Options& options) {
  const int frames = options.quick ? 60 : 400;
  const int few = options.quick ? 30 : 100;
  const int looks = options.quick ? 2 : 10;
  Timings all;
  const auto add = [&](Timings some) {
    for (const Timing& t : some) {
      std::clog << fmt::format("{} {} x{}: {} {}: {:.0f} us {}\n", t.scene, t.width, t.markers,
                               t.system, t.frames, t.us.median, t.note);
    }
    std::move(some.begin(), some.end(), std::back_inserter(all));
  };
  add(time_roundel(floor_scene(1, few)));
  for (const int markers : {7, 30, 100}) {
    for (const Experiment& scene : {floor_scene(markers, frames), clean_scene(markers, frames)}) {
      add(time_roundel(scene));
      if (options.no_peers) continue;
      for (const Contender& peer : peers()) add(time_peer(scene, peer, looks));
    }
    add(time_publishing(floor_scene(markers, few), options.lcm_url));
  }
  const Experiment seven = floor_scene(7, frames);
  add(time_empty(seven));
  add(time_missing(seven));
  add(time_light_drop(seven));
  add(time_jumps(seven));
  for (const int markers : {1, 3, 10, 30, 100, 300, 1000}) {
    add(time_roundel(crowd_scene(markers, few)));
  }
  for (const int width : {1280, 1920, 3840}) {
    const Experiment scene = resolution_scene(width, 10, few);
    add(time_roundel(scene));
    add(time_empty(scene));
  }
  return all;
}

std::ofstream open(const std::filesystem::path& path) {
  std::ofstream file(path);
  if (!file) throw std::runtime_error("cannot write " + path.string());
  return file;
}

void report(const Options& options) {
  const Timings timings = measure_all(options);
  if (options.out.empty()) {
    write_timings_markdown(std::cout, timings, options.quick);
    return;
  }
  const std::filesystem::path folder = options.out;
  std::filesystem::create_directories(folder);
  auto csv = open(folder / "speed.csv");
  write_timings_csv(csv, timings);
  auto markdown = open(folder / "speed.md");
  write_timings_markdown(markdown, timings, options.quick);
}

}  // namespace
}  // namespace roundel::bench

int main(int argc, char** argv) {
  roundel::bench::Options options;
  CLI::App app{"Speed of Roundel and its peers on the same scenes"};
  app.add_option("--out", options.out, "folder for speed.md and speed.csv; none: standard output");
  app.add_option("--lcm", options.lcm_url, "LCM URL that poses are sent to (default memq://)");
  app.add_flag("--quick", options.quick, "few frames");
  app.add_flag("--no-peers", options.no_peers, "Roundel alone");
  CLI11_PARSE(app, argc, argv);
  try {
    roundel::bench::report(options);
  } catch (const std::exception& e) {
    std::cerr << "bench_speed: " << e.what() << '\n';
    return 1;
  }
  return 0;
}
