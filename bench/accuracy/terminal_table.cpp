#include <fmt/ostream.h>

#include "bench/accuracy/figures.hpp"
#include "bench/accuracy/report.hpp"

namespace roundel::bench {

void print_table(std::ostream& out, const std::vector<Summary>& summaries) {
  constexpr const char* kRow =
      "{:<21}{:<21}{:>6} {:>7} {:>4} {:>4} {:>4} {:>4}{:>4} |{:>8}{:>8}{:>7}{:>7} "
      "|{:>8}{:>8}{:>8}{:>8} "
      "|{:>8}{:>7}{:>7} {:>6} |{:>6}{:>6}{:>7} |{:>7}{:>7}{:>5}{:>8}\n";
  fmt::print(out, fmt::runtime(kRow), "set", "system", "n", "found%", "miss", "unrd", "wrng",
             "xtra", "xid", "pos mm", "median", "p99", "worst", "phi", "median", "p99", "worst",
             "normal", "p99", "worst", "flip%", "z2pos", "z2rot", "sig mm", "rms", "bound", "eff",
             "bd phi");
  std::string last;
  for (const Summary& s : summaries) {
    if (!last.empty() && s.experiment != last) fmt::print(out, "\n");
    last = s.experiment;
    fmt::print(out, fmt::runtime(kRow), s.experiment, s.system, s.judged,
               figure(100 * s.found_share(), "{:.2f}"), s.missed, s.unread, s.wrong_ids, s.extra,
               s.extra_ids, figure(s.position_mm.mean, "{:.3f}"),
               figure(s.position_mm.median, "{:.3f}"), figure(s.position_mm.p99, "{:.2f}"),
               figure(s.position_mm.worst, "{:.2f}"), yaw_figure(s, s.phi.mean, "{:.5f}"),
               yaw_figure(s, s.phi.median, "{:.5f}"), yaw_figure(s, s.phi.p99, "{:.5f}"),
               yaw_figure(s, s.phi.worst, "{:.5f}"), figure(s.normal.mean, "{:.5f}"),
               figure(s.normal.p99, "{:.4f}"), figure(s.normal.worst, "{:.4f}"),
               figure(100 * s.flip_share(), "{:.2f}"),
               sigma_figure(s, s.position_honesty, "{:.2f}"),
               s.has_yaw ? sigma_figure(s, s.rotation_honesty, "{:.2f}") : "-",
               sigma_figure(s, s.mean_sigma_mm, "{:.3f}"), figure(s.position_rms_mm, "{:.3f}"),
               figure(s.bound_rms_mm, "{:.3f}"), figure(s.efficiency, "{:.2f}"),
               yaw_figure(s, s.bound_phi_median, "{:.5f}"));
  }
}

}  // namespace roundel::bench
