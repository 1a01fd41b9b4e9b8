#include "bench/accuracy/summary.hpp"

#include <cmath>
#include <numbers>

namespace roundel::bench {

namespace {

constexpr double kSteep = 75 * std::numbers::pi / 180;

// Of records with sigmas.
class Honesty {
 public:
  void add(const Record& record) {
    for (int axis = 0; axis < 6; ++axis) {
      const double error = axis < 3 ? record.position_error[axis] : record.rotation_error[axis - 3];
      const double sigma = axis < 3 ? record.sigma_position[axis] : record.sigma_rotation[axis - 3];
      const double square = error * error / (sigma * sigma);
      squares_[static_cast<std::size_t>(axis)] += square;
      if (square <= 1) ++within_;
    }
    size_ += record.sigma_position.norm();
    ++count_;
  }

  void write(Summary& s) const {
    s.has_sigma = count_ > 0;
    if (count_ == 0) return;
    for (std::size_t axis = 0; axis < 6; ++axis) {
      s.axis_honesty[axis] = squares_[axis] / count_;
      s.sum_of_squares += s.axis_honesty[axis];
      (axis < 3 ? s.position_honesty : s.rotation_honesty) += s.axis_honesty[axis] / 3;
    }
    s.within_sigma = static_cast<double>(within_) / (6.0 * count_);
    s.mean_sigma_mm = 1000 * size_ / count_;
  }

 private:
  std::array<double, 6> squares_{};
  double size_ = 0;
  int count_ = 0, within_ = 0;
};

}  // namespace

Summary summarise(const Result& result) {
  Summary s;
  s.experiment = result.experiment->name;
  s.system = result.system;
  s.has_yaw = result.has_yaw;
  s.extra = result.verdicts.extra;
  s.extra_ids = result.verdicts.extra_ids;
  s.sure_ids = s.sure_wrong_ids = result.verdicts.extra_sure_ids;
  Honesty honesty;
  std::vector<double> position, phi, normal;
  std::vector<double> squared_error, squared_bound, bound_phi;
  for (const Record& record : result.verdicts.records) {
    ++s.judged;
    const bool steep = record.incidence > kSteep;
    if (!steep) ++s.judged_to_75;
    if (record.read >= 0 && record.id_probability >= kSure) {
      ++s.sure_ids;
      if (record.outcome == Outcome::kWrongId) ++s.sure_wrong_ids;
    }
    switch (record.outcome) {
      case Outcome::kFound:
        ++s.found;
        if (!steep) ++s.found_to_75;
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
    if (record.has_sigma) honesty.add(record);
  }
  s.position_mm = distribution_of(position);
  s.phi = distribution_of(phi);
  s.normal = distribution_of(normal);
  honesty.write(s);
  s.position_rms_mm = std::sqrt(mean_of(squared_error));
  s.bound_rms_mm = std::sqrt(mean_of(squared_bound));
  s.efficiency = mean_of(squared_bound) / mean_of(squared_error);
  s.bound_phi_median = distribution_of(bound_phi).median;
  return s;
}

}  // namespace roundel::bench
