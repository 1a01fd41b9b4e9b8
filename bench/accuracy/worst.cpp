#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <numbers>

#include "bench/accuracy/report.hpp"

namespace roundel::bench {

namespace {

const char* name_of(Outcome outcome) {
  switch (outcome) {
    case Outcome::kFound:
      return "found";
    case Outcome::kUnread:
      return "unread";
    case Outcome::kWrongId:
      return "wrong_id";
    case Outcome::kMissed:
      break;
  }
  return "missed";
}

void write_row(std::ostream& out, const Result& result, const char* why, const Record& record) {
  const Experiment& experiment = *result.experiment;
  const Eigen::Vector3d& p = record.truth.position;
  const Eigen::Quaterniond& q = record.truth.orientation;
  const Eigen::Vector2d pixel = experiment.camera.project(p).value();
  const Eigen::Vector3d error_mm = 1000 * record.position_error;
  const Eigen::Vector3d sigma_mm = 1000 * record.sigma_position;
  fmt::print(
      out,
      "{},{},{},{},{},{},{},{:.2f},{:.2f},{:.2f},{:.1f},{:.6f},{:.6f},{:.6f},{:.8f},{:.8f},"
      "{:.8f},{:.8f},{:.3f},{:.3f},{:.3f},{:.3f},{:.6f},{:.6f},{:.3f},{:.3f},{:.3f},{:.4f}\n",
      experiment.name, result.system, why, record.view, record.number, record.read,
      name_of(record.outcome), record.incidence * 180 / std::numbers::pi, pixel.x(), pixel.y(),
      record.short_side_px, p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z(), error_mm.norm(),
      error_mm.x(), error_mm.y(), error_mm.z(), record.phi, record.normal_error, sigma_mm.x(),
      sigma_mm.y(), sigma_mm.z(), record.ambiguity);
}

template <typename Key>
void write_largest(std::ostream& out, const Result& result, const char* why, std::size_t count,
                   Key&& key) {
  std::vector<const Record*> records;
  for (const Record& record : result.verdicts.records) {
    if (record.outcome == Outcome::kFound) records.push_back(&record);
  }
  count = std::min(count, records.size());
  std::partial_sort(records.begin(), records.begin() + static_cast<std::ptrdiff_t>(count),
                    records.end(),
                    [&](const Record* a, const Record* b) { return key(*a) > key(*b); });
  for (std::size_t i = 0; i < count; ++i) write_row(out, result, why, *records[i]);
}

}  // namespace

void write_worst_csv(std::ostream& out, const std::vector<Result>& results, std::size_t count) {
  fmt::print(out,
             "set,system,why,view,number,read,outcome,incidence_deg,u,v,short_side_px,x,y,z,qw,qx,"
             "qy,qz,position_error_mm,ex_mm,ey_mm,ez_mm,phi,normal_error,sx_mm,sy_mm,sz_mm,"
             "ambiguity\n");
  for (const Result& result : results) {
    std::size_t not_found = 0;
    for (const Record& record : result.verdicts.records) {
      if (record.outcome == Outcome::kFound || ++not_found > count) continue;
      write_row(out, result, "not_found", record);
    }
    write_largest(out, result, "position", count,
                  [](const Record& r) { return r.position_error.norm(); });
    write_largest(out, result, "normal", count, [](const Record& r) { return r.normal_error; });
  }
}

}  // namespace roundel::bench
