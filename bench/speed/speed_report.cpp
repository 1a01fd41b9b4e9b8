#include "bench/speed/speed_report.hpp"

#include <fmt/ostream.h>

#include "bench/speed/speed_targets.hpp"

namespace roundel::bench {

namespace {

constexpr const char* kIntroduction = R"(# Speed

Written by `bench/run-speed`; do not edit. The paper's timing experiment: the same scenes rendered for each
system, 8.4 cm markers in Full HD (41 px) on a cluttered floor with noise 3 and blur 0.7, and a clean
picture. One thread each; processor time of that thread, in microseconds a frame, from the picture in memory to
poses. The machine is shared: **compare within one run**, by ratios.

- `roundel` is the tracker with default parameters, as the daemon runs it. **following**: markers are known from
  the frames before; **first**: nothing is known. A peer has no memory: every frame is a first one.
- `apriltag-36h11-d1`, `-d2`: AprilTag 3 of Debian's libapriltag, quads at full and at half resolution, one
  corrected bit; with poses. `aruco`: Debian's OpenCV, 4x4, default settings (no sub-pixel corners); with poses.
- **seen**: markers reported (peers: with an id) over markers in the picture; some are cut by the border.
)";

void write_row(std::ostream& out, const Timing& t, const Timings& all) {
  const auto ratio = [&](const char* frames) {
    if (t.system == "roundel") return std::string("-");
    const Timing* ours = find_timing(all, t.scene, "roundel", frames, t.width, t.markers);
    return ours == nullptr ? std::string("-")
                           : fmt::format("{:.0f} ×", t.us.median / ours->us.median);
  };
  fmt::print(
      out,
      "| {} | {} | {} | {} | {} | {:.0f} | {:.0f} | {:.0f} | {:.0f} | {:.0f} % | {} | {} | {} |\n",
      t.scene, t.width, t.markers, t.system, t.frames, t.us.mean, t.us.median, t.us.p99, t.us.worst,
      100 * t.seen, ratio("following"), ratio("first"), t.note);
}

}  // namespace

void write_timings_csv(std::ostream& out, const Timings& timings) {
  fmt::print(
      out, "scene,width,markers,system,frames,mean_us,median_us,p99_us,worst_us,count,seen,note\n");
  for (const Timing& t : timings) {
    fmt::print(out, "{},{},{},{},{},{:.2f},{:.2f},{:.2f},{:.2f},{},{:.4f},{}\n", t.scene, t.width,
               t.markers, t.system, t.frames, t.us.mean, t.us.median, t.us.p99, t.us.worst, t.count,
               t.seen, t.note);
  }
}

void write_timings_markdown(std::ostream& out, const Timings& timings, bool quick) {
  out << kIntroduction;
  if (quick) out << "\n**A quick run, of few frames: an impression, no result.**\n";
  write_speed_targets(out, timings);
  fmt::print(out,
             "\n## All times\n\nThe ratios are the medians', over Roundel's following and first "
             "frames.\n\n| scene | width | markers | system | frames | mean µs | median | p99 | "
             "worst | seen | "
             "/ following | / first | |\n|---|--:|--:|---|---|--:|--:|--:|--:|--:|--:|--:|---|\n");
  for (const Timing& t : timings) write_row(out, t, timings);
  fmt::print(out,
             "\n## How cost grows\n\n![following frames by markers](growth-markers.svg)\n\n"
             "![by resolution, with the same markers](growth-resolution.svg)\n");
}

}  // namespace roundel::bench
