#include "core/curve_evidence.hpp"

#include <algorithm>
#include <cmath>

namespace roundel {

namespace {

// Before anything is seen: linear, give or take.
constexpr double kPriorSigma = 0.5;
// No marker is sharper than that about the exponent: what it gets wrong is not only noise.
constexpr double kLeastSigma = 0.05;
constexpr double kFading = 0.98;  // a marker
constexpr double kLowest = 0.6, kHighest = 2.8;

// A curve is taken for none until it is so many deviations, and so much, from linear; a change of
// the exponent costs every track a new start, so it has to be worth that.
constexpr double kClear = 5, kCurved = 0.15, kWorthAChange = 0.03;

// From then on a marker now and then is enough.
constexpr double kSettledSigma = 0.02;
constexpr int kNowAndThen = 16;

}  // namespace

double CurveEvidence::centre() const {
  const double information = information_ + 1 / (kPriorSigma * kPriorSigma);
  return std::clamp(1 + weighted_ / information, kLowest, kHighest);
}

bool CurveEvidence::is_settled() const {
  return information_ >= 1 / (kSettledSigma * kSettledSigma);
}

bool CurveEvidence::wants_more() {
  return !is_settled() || ++asked_ % kNowAndThen == 0;
}

void CurveEvidence::add(const std::array<double, 3>& squares) {
  const double middle = centre();
  const double slope = (squares[2] - squares[0]) / (2 * kProbe);
  const double bend = (squares[2] - 2 * squares[1] + squares[0]) / (kProbe * kProbe);
  if (!std::isfinite(slope) || !std::isfinite(bend)) return;
  // The squares' minimum, by their parabola; one far outside of what was looked at is only a
  // direction.
  constexpr double kFarthest = 2 * kProbe;
  double step = bend > 0 ? -slope / bend : (slope > 0 ? -kFarthest : kFarthest);
  double information = 0.5 * std::max(bend, std::abs(slope) / kFarthest);
  if (std::abs(step) > kFarthest) {
    step = std::clamp(step, -kFarthest, kFarthest);
    information *= 0.1;
  }
  information = std::min(information, 1 / (kLeastSigma * kLeastSigma));
  information_ = kFading * information_ + information;
  weighted_ = kFading * weighted_ + information * (middle + step - 1);

  const double sigma = 1 / std::sqrt(information_ + 1 / (kPriorSigma * kPriorSigma));
  const double estimate = centre(), away = std::abs(estimate - 1);
  const bool curved = away > kCurved && away > kClear * sigma;
  if (!curved) {
    if (away < kCurved / 2) exponent_ = 1;
  } else if (std::abs(estimate - exponent_) > std::max(kWorthAChange, 2 * sigma)) {
    exponent_ = estimate;
  }
}

}  // namespace roundel
