#include <fmt/ostream.h>

#include "bench/accuracy/figures.hpp"
#include "bench/accuracy/report.hpp"

namespace roundel::bench {

namespace {

constexpr const char* kIntroduction = R"(# Accuracy

See also: [is the probability of an id what it says?](reliability.md),
[markers where there are none](false_markers.md), [the arena in 2D mode](arena_2d.md),
[speed](speed.md); all figures in accuracy.csv.
One thing varied at a time, with every system: [tilt](sweep-tilt.svg), [distance](sweep-distance.svg),
[noise](sweep-noise.svg), [blur](sweep-blur.svg), [gamma](sweep-gamma.svg), [size](sweep-size.svg).

![position](position.svg)

![orientation](orientation.svg)


Written by `bench/run-accuracy`; do not edit. The paper's experiments in our rendition (METHOD.md
sections 8 and 9): every system sees the same poses, through the same lens, blur and noise; only what
is printed on the white plates (1.35 times the print) differs. A square tag's outer black side is a
circular marker's outer black diameter.

- **found**: share of the judged markers that were seen with the right id; the errors are theirs.
- **position**: distance between true and measured centre. **φ**: arccos |q1 · q2|, the paper's
  orientation error. **normal**: angle between the printed faces' normals. **flips**: share of the
  found markers whose normal is off by more than 0.2 rad. **false**: sightings where there is no marker.
- **z²**: mean of (error / published sigma)² by axis of the camera, flips left out; 1 = honest, above =
  too sure of itself. Their sum is 6, and 68 % of the errors lie within a sigma, where the sigmas are
  honest and the errors normal. Published are the six diagonal elements, so each axis stands for itself.
- **bound**: root mean square of the Cramér–Rao bound of each view's position, given the pixels, noise
  and rounding, with the two grey levels and the blur unknown. It belongs to the print, so that peers
  have their own. **efficiency**: bound² / error², flips left out. Without noise the bound is that of
  rounding to whole grey levels alone.
- `roundel` is the detector on single pictures, `-track` the tracker, as the daemon runs it; `-whycon`
  are plain rings without a code, for which there is no φ. All with default parameters.
- Peers take up to 0.3 s a picture, so they are shown a part of the same pictures: one in 3 of the artificial
  poses, one in 4 of the manipulator's, one in 20 frames with 7 robots and in 10 with more, one in 4 of the sweeps.
- AprilTag 3 (Debian's libapriltag): no decimation, one corrected bit, decision margin 30 or more,
  corners undistorted and moved by half a pixel. ArUco (Debian's OpenCV): 4x4, default settings, pose
  by IPPE_SQUARE; `-subpix` refines the corners within 0.6 cells.
)";

void write_errors(std::ostream& out, const Experiment& experiment,
                  const std::vector<Summary>& summaries) {
  fmt::print(out,
             "| system | found | missed | no id | wrong id | false (with id) | position mm: mean | "
             "median | p99 | "
             "worst | φ rad: mean | median | p99 | worst | normal rad: mean | flips |\n"
             "|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n");
  for (const Summary& s : summaries) {
    if (s.experiment != experiment.name) continue;
    fmt::print(out,
               "| {} | {:.2f} % | {} | {} | {} | {} ({}) | {} | {} | {} | {} | {} | {} | {} | {} | "
               "{} | {} |\n",
               s.system, 100 * s.found_share(), s.missed, s.unread, s.wrong_ids, s.extra,
               s.extra_ids, figure(s.position_mm.mean, "{:.3f}"),
               figure(s.position_mm.median, "{:.3f}"), figure(s.position_mm.p99, "{:.2f}"),
               figure(s.position_mm.worst, "{:.2f}"), yaw_figure(s, s.phi.mean, "{:.5f}"),
               yaw_figure(s, s.phi.median, "{:.5f}"), yaw_figure(s, s.phi.p99, "{:.5f}"),
               yaw_figure(s, s.phi.worst, "{:.5f}"), figure(s.normal.mean, "{:.5f}"),
               s.found > 0 ? figure(100 * s.flip_share(), "{:.2f} %") : "-");
  }
}

void write_limits(std::ostream& out, const Experiment& experiment,
                  const std::vector<Summary>& summaries) {
  fmt::print(
      out,
      "\n| system | position rms mm | bound mm | efficiency | φ median | its bound | sigma mm "
      "| z² x · y · z | z² rotations | sum of six | within σ "
      "|\n|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n");
  for (const Summary& s : summaries) {
    if (s.experiment != experiment.name) continue;
    const auto& z = s.axis_honesty;
    fmt::print(
        out, "| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |\n", s.system,
        figure(s.position_rms_mm, "{:.3f}"), figure(s.bound_rms_mm, "{:.3f}"),
        figure(s.efficiency, "{:.2f}"), yaw_figure(s, s.phi.median, "{:.5f}"),
        yaw_figure(s, s.bound_phi_median, "{:.5f}"), sigma_figure(s, s.mean_sigma_mm, "{:.3f}"),
        s.has_sigma ? fmt::format("{:.2f} · {:.2f} · {:.2f}", z[0], z[1], z[2]) : "-",
        s.has_sigma && s.has_yaw ? fmt::format("{:.2f} · {:.2f} · {:.2f}", z[3], z[4], z[5]) : "-",
        s.has_yaw ? sigma_figure(s, s.sum_of_squares, "{:.1f}") : "-",
        s.has_yaw ? sigma_figure(s, 100 * s.within_sigma, "{:.0f} %") : "-");
  }
}

}  // namespace

void write_markdown(std::ostream& out, const std::vector<Experiment>& experiments,
                    const std::vector<Summary>& summaries, bool quick) {
  out << kIntroduction;
  if (quick) out << "\n**A quick run, with a tenth of the poses: an impression, no result.**\n";
  for (const Experiment& experiment : experiments) {
    int judged = 0;
    for (const Summary& s : summaries) {
      if (s.experiment == experiment.name) judged = s.judged;
    }
    fmt::print(out, "\n## {} (`{}`, {} markers judged)\n\n", experiment.title, experiment.name,
               judged);
    write_errors(out, experiment, summaries);
    write_limits(out, experiment, summaries);
  }
}

}  // namespace roundel::bench
