#include "bench/accuracy/report.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <cmath>

namespace roundel::bench {

namespace {

// "-" for what does not exist.
std::string number(double value, const char* format) {
  return std::isfinite(value) ? fmt::format(fmt::runtime(format), value) : "-";
}

std::string phi(const Summary& s, double value) {
  return s.has_yaw ? number(value, "{:.5f}") : "-";
}

std::string honesty(const Summary& s, double value) {
  return s.has_sigma ? number(value, "{:.2f}") : "-";
}

}  // namespace

void print_table(std::ostream& out, const std::vector<Summary>& summaries) {
  fmt::print(out,
             "{:<20}{:<22}{:>6} {:>7} {:>4} {:>4} {:>4} {:>4} |{:>8}{:>8}{:>8}{:>8} |{:>8}{:>8}"
             "{:>8}{:>8} |{:>8}{:>8}{:>8} {:>6} |{:>6}{:>6}{:>7}\n",
             "set", "system", "n", "found%", "miss", "unrd", "wrng", "xtra", "pos mm", "median",
             "p99", "worst", "phi", "median", "p99", "worst", "normal", "p99", "worst", "flip%",
             "z2pos", "z2rot", "sig mm");
  std::string last;
  for (const Summary& s : summaries) {
    if (!last.empty() && s.experiment != last) fmt::print(out, "\n");
    last = s.experiment;
    fmt::print(
        out,
        "{:<20}{:<22}{:>6} {:>7.2f} {:>4} {:>4} {:>4} {:>4} |{:>8}{:>8}{:>8}{:>8} |{:>8}{:>8}{:>8}"
        "{:>8} |{:>8}{:>8}{:>8} {:>6} |{:>6}{:>6}{:>7}\n",
        s.experiment, s.system, s.judged, 100 * s.found_share(), s.missed, s.unread, s.wrong_ids,
        s.extra, number(s.position_mm.mean, "{:.3f}"), number(s.position_mm.median, "{:.3f}"),
        number(s.position_mm.p99, "{:.2f}"), number(s.position_mm.worst, "{:.2f}"),
        phi(s, s.phi.mean), phi(s, s.phi.median), phi(s, s.phi.p99), phi(s, s.phi.worst),
        number(s.normal.mean, "{:.5f}"), number(s.normal.p99, "{:.4f}"),
        number(s.normal.worst, "{:.4f}"), number(100 * s.flip_share(), "{:.2f}"),
        honesty(s, s.position_honesty), s.has_yaw ? honesty(s, s.rotation_honesty) : "-",
        honesty(s, s.mean_sigma_mm));
  }
}

void write_summary_csv(std::ostream& out, const std::vector<Summary>& summaries) {
  fmt::print(out,
             "set,system,judged,found,unread,wrong_ids,missed,extra,flips,"
             "position_mean_mm,position_median_mm,position_p99_mm,position_worst_mm,"
             "phi_mean,phi_median,phi_p99,phi_worst,"
             "normal_mean,normal_median,normal_p99,normal_worst,"
             "position_z2,rotation_z2,mean_sigma_mm\n");
  for (const Summary& s : summaries) {
    fmt::print(out, "{},{},{},{},{},{},{},{},{}", s.experiment, s.system, s.judged, s.found,
               s.unread, s.wrong_ids, s.missed, s.extra, s.flips);
    for (const Distribution* d : {&s.position_mm, &s.phi, &s.normal}) {
      const bool exists = d != &s.phi || s.has_yaw;
      for (const double value : {d->mean, d->median, d->p99, d->worst}) {
        fmt::print(out, ",{}", exists ? number(value, "{:.6g}") : "");
      }
    }
    for (const double value : {s.position_honesty, s.rotation_honesty, s.mean_sigma_mm}) {
      fmt::print(out, ",{}", s.has_sigma ? number(value, "{:.4g}") : "");
    }
    fmt::print(out, "\n");
  }
}

void write_markdown(std::ostream& out, const std::vector<Experiment>& experiments,
                    const std::vector<Summary>& summaries) {
  for (const Experiment& experiment : experiments) {
    fmt::print(out, "\n## {} (`{}`)\n\n", experiment.title, experiment.name);
    fmt::print(
        out,
        "| system | n | found | missed | no id | wrong id | position mm: mean | median | p99 "
        "| worst | phi rad: mean | median | p99 | worst | normal rad: mean | flips | z2 "
        "position | z2 rotation | sigma mm |\n|---|{}\n",
        [] {
          std::string columns;
          for (int k = 0; k < 18; ++k) columns += "--:|";
          return columns;
        }());
    for (const Summary& s : summaries) {
      if (s.experiment != experiment.name) continue;
      fmt::print(out,
                 "| {} | {} | {:.2f} % | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} "
                 "| {} % | {} | {} | {} |\n",
                 s.system, s.judged, 100 * s.found_share(), s.missed, s.unread, s.wrong_ids,
                 number(s.position_mm.mean, "{:.3f}"), number(s.position_mm.median, "{:.3f}"),
                 number(s.position_mm.p99, "{:.2f}"), number(s.position_mm.worst, "{:.2f}"),
                 phi(s, s.phi.mean), phi(s, s.phi.median), phi(s, s.phi.p99), phi(s, s.phi.worst),
                 number(s.normal.mean, "{:.5f}"), number(100 * s.flip_share(), "{:.2f}"),
                 honesty(s, s.position_honesty), s.has_yaw ? honesty(s, s.rotation_honesty) : "-",
                 honesty(s, s.mean_sigma_mm));
    }
  }
}

}  // namespace roundel::bench
