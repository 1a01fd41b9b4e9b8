#pragma once

#include <array>

namespace roundel {

// What markers tell of a camera's response curve that nobody has told. Edges are blurred in light:
// seen through a curve their profile is lopsided, and only under the right curve does a marker's
// model fit. Curves are those of ResponseCurve::like_srgb(); the evidence of all markers and frames
// is one estimate of their exponent. Old evidence fades, so that a camera may change its curve.
class CurveEvidence {
 public:
  static constexpr double kProbe = 0.25;

  // Where to look next: the likeliest exponent.
  double centre() const;

  // A marker was fitted with exponents centre() - kProbe, centre() and centre() + kProbe; the sums
  // of its squared residuals, in units of their variance.
  void add(const std::array<double, 3>& squares);

  // Whether a further marker would tell something new. To be asked once for every marker.
  bool wants_more();
  // Whether a marker now and then is enough.
  bool is_settled() const;

  // The exponent to be used. 1, the linear one, until the evidence is clear that it is not.
  double exponent() const { return exponent_; }

  void forget() { *this = {}; }

 private:
  double information_ = 0, weighted_ = 0;  // inverse variance of the estimate, and times it
  double exponent_ = 1;
  int asked_ = 0;
};

}  // namespace roundel
