#include "bench/accuracy/summary.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace roundel::bench {

namespace {

double squared_norm_in_sigmas(const Eigen::Vector3d& error, const Eigen::Vector3d& sigma) {
  return (error.array() / sigma.array()).square().mean();
}

double mean_of(const std::vector<double>& values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

}  // namespace

Distribution distribution_of(std::vector<double> values) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  if (values.empty()) return {kNone, kNone, kNone, kNone};
  const double mean = mean_of(values);
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    return values[static_cast<std::size_t>(
        std::lround(share * static_cast<double>(values.size() - 1)))];
  };
  return {mean, at(0.5), at(0.99), values.back()};
}

Summary summarise(const Result& result) {
  Summary s;
  s.experiment = result.experiment->name;
  s.system = result.system;
  s.has_yaw = result.has_yaw;
  s.extra = result.verdicts.extra;
  s.extra_ids = result.verdicts.extra_ids;
  std::vector<double> position, phi, normal, position_honesty, rotation_honesty, sigma;
  std::vector<double> squared_error, squared_bound, bound_phi;
  for (const Record& record : result.verdicts.records) {
    ++s.judged;
    switch (record.outcome) {
      case Outcome::kFound:
        ++s.found;
        break;
      case Outcome::kUnread:
        ++s.unread;
        continue;
      case Outcome::kWrongId:
        ++s.wrong_ids;
        continue;
      case Outcome::kMissed:
        ++s.missed;
        continue;
    }
    position.push_back(1000 * record.position_error.norm());
    phi.push_back(record.phi);
    normal.push_back(record.normal_error);
    if (record.flipped()) {
      ++s.flips;
      continue;
    }
    if (record.has_bound()) {
      squared_error.push_back(1e6 * record.position_error.squaredNorm());
      squared_bound.push_back(1e6 * record.bound_position * record.bound_position);
      bound_phi.push_back(0.5 * record.bound_rotation);
    }
    if (!record.has_sigma) continue;
    s.has_sigma = true;
    position_honesty.push_back(
        squared_norm_in_sigmas(record.position_error, record.sigma_position));
    rotation_honesty.push_back(
        squared_norm_in_sigmas(record.rotation_error, record.sigma_rotation));
    sigma.push_back(1000 * record.sigma_position.norm());
  }
  s.position_mm = distribution_of(position);
  s.phi = distribution_of(phi);
  s.normal = distribution_of(normal);
  s.position_honesty = mean_of(position_honesty);
  s.rotation_honesty = mean_of(rotation_honesty);
  s.mean_sigma_mm = mean_of(sigma);
  s.position_rms_mm = std::sqrt(mean_of(squared_error));
  s.bound_rms_mm = std::sqrt(mean_of(squared_bound));
  s.efficiency = mean_of(squared_bound) / mean_of(squared_error);
  s.bound_phi_median = distribution_of(bound_phi).median;
  return s;
}

}  // namespace roundel::bench
