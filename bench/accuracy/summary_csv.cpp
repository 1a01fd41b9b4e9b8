#include <fmt/ostream.h>

#include "bench/accuracy/figures.hpp"
#include "bench/accuracy/report.hpp"

namespace roundel::bench {

void write_summary_csv(std::ostream& out, const std::vector<Summary>& summaries,
                       const std::vector<const SweepPoint*>& sweep_points) {
  const bool sweeping = !sweep_points.empty();
  fmt::print(
      out,
      "{},system,judged,found_percent,missed,no_id,wrong_id,extra,extra_with_id,flips_percent,"
      "position_mean_mm,position_median_mm,position_p99_mm,position_worst_mm,"
      "phi_mean,phi_median,phi_p99,phi_worst,"
      "normal_mean,normal_median,normal_p99,normal_worst,"
      "position_z2,rotation_z2,sigma_mm,"
      "z2_x,z2_y,z2_z,z2_rx,z2_ry,z2_rz,within_sigma_percent,sure_ids,sure_wrong_ids,"
      "found_to_75_percent,"
      "position_rms_mm,bound_rms_mm,efficiency,bound_phi_median\n",
      sweeping ? "sweep,value" : "set");
  for (std::size_t i = 0; i < summaries.size(); ++i) {
    const Summary& s = summaries[i];
    fmt::print(out, "{}",
               sweeping ? fmt::format("{},{:g}", sweep_points[i]->sweep, sweep_points[i]->value)
                        : s.experiment);
    fmt::print(out, ",{},{},{:.3f},{},{},{},{},{},{}", s.system, s.judged, 100 * s.found_share(),
               s.missed, s.unread, s.wrong_ids, s.extra, s.extra_ids,
               s.found > 0 ? figure(100 * s.flip_share(), "{:.3f}") : "");
    for (const double value :
         {s.position_mm.mean, s.position_mm.median, s.position_mm.p99, s.position_mm.worst}) {
      fmt::print(out, ",{}", figure(value, "{:.4g}", ""));
    }
    for (const double value : {s.phi.mean, s.phi.median, s.phi.p99, s.phi.worst}) {
      fmt::print(out, ",{}", yaw_figure(s, value, "{:.4g}", ""));
    }
    for (const double value : {s.normal.mean, s.normal.median, s.normal.p99, s.normal.worst}) {
      fmt::print(out, ",{}", figure(value, "{:.4g}", ""));
    }
    for (const double value : {s.position_honesty, s.rotation_honesty, s.mean_sigma_mm}) {
      fmt::print(out, ",{}", sigma_figure(s, value, "{:.4g}", ""));
    }
    for (const double value : s.axis_honesty) {
      fmt::print(out, ",{}", sigma_figure(s, value, "{:.4g}", ""));
    }
    fmt::print(out, ",{},{},{},{:.3f}", sigma_figure(s, 100 * s.within_sigma, "{:.1f}", ""),
               s.sure_ids, s.sure_wrong_ids, 100 * s.found_share_to_75());
    for (const double value : {s.position_rms_mm, s.bound_rms_mm, s.efficiency}) {
      fmt::print(out, ",{}", figure(value, "{:.4g}", ""));
    }
    fmt::print(out, ",{}\n", yaw_figure(s, s.bound_phi_median, "{:.4g}", ""));
  }
}

}  // namespace roundel::bench
