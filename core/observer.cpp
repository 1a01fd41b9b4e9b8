#include "core/observer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "core/conic.hpp"
#include "core/covariance.hpp"
#include "core/plain_look.hpp"

namespace roundel {

namespace {

// Noise of what is read off a thresholded outline, pixels: an edge pixel is in or out, which alone
// spreads evenly over a pixel. Used to weigh the hypotheses and for the published deviations.
constexpr double kOutlineNoise = 0.30;
constexpr double kToothEdgeNoise = 0.15;

// Residuals of a fitted marker stay below this share of its contrast, noise of a tenth included;
// what has more is something else.
constexpr double kMaxResidual = 0.12;

// Pixels farther from an edge tell nothing of it under any usual blur.
constexpr double kReach = 3.0;

// Residuals of a rough start, share of the contrast.
constexpr double kFirstDeviation = 0.15;

// A hypothesis behind by so much in its log-likelihood before it is refined stays behind.
constexpr double kDecided = 1000;

// A first, rough fit uses one of so many blocks of pixels, or more, so that so many pixels are in
// it; a hypothesis that it leaves behind by so much in its log-likelihood is not refined further.
constexpr int kRoughEvery = 4, kRoughPixels = 300;
constexpr double kFarBehind = 40;
// Standard deviations that its last step may leave undone.
constexpr double kRoughlySettled = 0.5;
constexpr double kSame = 0.02;  // of the normals, radians

// Residuals that a roughly fitted start adds, share of the contrast.
constexpr double kSecondDeviation = 0.03;

void require(bool condition, const char* what) {
  if (!condition) throw std::invalid_argument(what);
}

void check(const DetectorParameters& p) {
  require(p.diameter_m > 0 && std::isfinite(p.diameter_m),
          "the marker's diameter must be positive");
  require(p.inner_ratio == 0 || (p.inner_ratio >= 0.2 && p.inner_ratio <= 0.7),
          "inner_ratio must be 0.2 to 0.7, or 0 when it is not known");
  require(p.max_markers >= 1 && p.max_markers <= 100000, "max_markers must be 1 to 100000");
  require(p.min_diameter_px >= 6, "min_diameter_px must be 6 or more");
  require(p.max_diameter_px >= p.min_diameter_px,
          "max_diameter_px must not be below min_diameter_px");
  require(p.min_contrast >= 5 && p.min_contrast <= 200,
          "min_contrast must be 5 to 200 grey levels");
}

// Whether the bright part is the disc of a plain marker: an ellipse shaped like the outer one and
// of a printed ratio. Or so small that the pixel grid hides what it is.
bool may_be_plain_centre(const Segment& segment) {
  const Ellipse& inner = segment.inner;
  const double ratio = std::sqrt(segment.bright_share);
  constexpr double kTooSmallToTell = 3;  // pixels
  if (inner.b < kTooSmallToTell) return true;
  const double grid = 0.5 / inner.b;  // half a pixel, as a share of the smaller axis
  if (ratio < kPlainInnerRatioMin - 0.05 - grid || ratio > kPlainInnerRatioMax + 0.05) return false;
  const double ellipse_area = std::numbers::pi * inner.a * inner.b;
  const double area =
      segment.bright_share * std::numbers::pi * segment.ellipse.a * segment.ellipse.b;
  if (std::abs(ellipse_area / area - 1) > 0.02 + 0.1 * grid) return false;
  const double tolerance = 0.06 + grid;
  return std::abs(inner.a / (ratio * segment.ellipse.a) - 1) < tolerance &&
         std::abs(inner.b / (ratio * segment.ellipse.b) - 1) < tolerance;
}

// The paper in the middle is that of the margin: of a lid with a hole, or what else is dark around
// something bright, the floor around has a light of its own.
bool same_paper(const LumaView& frame, const Segment& segment) {
  constexpr double kOtherLight = 0.4;  // share of the contrast; half a shadow makes as much
  constexpr double kTooSmall = 3;      // pixels: blur darkens what is smaller
  const int u = static_cast<int>(std::lround(segment.inner.u));
  const int v = static_cast<int>(std::lround(segment.inner.v));
  double sum = 0;
  for (int dv = -1; dv <= 1; ++dv) {
    for (int du = -1; du <= 1; ++du) sum += frame.at(u + du, v + dv);
  }
  const double brighter = (sum / 9 - segment.levels.bright) / segment.levels.contrast();
  return brighter < kOtherLight && (brighter > -kOtherLight || segment.inner.b < kTooSmall);
}

// A printed disc is as large as it should be to so much of the black one's radius. The picture
// tells a print of another ratio by as much as blur, an unknown curve of the camera and the pixel
// grid leave of its area.
constexpr double kPrintedRatioSigma = 0.0005;
constexpr double kOtherRatio = 0.012, kOtherRatioPx = 0.5;

double mean_radius(const Ellipse& ellipse) {
  return std::sqrt(ellipse.a * ellipse.b);
}

// How well a plain marker's bright centre fits a pose ([P] 3.1.1): the centroid of the inner disc's
// image lies on the line from the image of the common centre to the outer ellipse's centre, at the
// share of the discs' areas.
double plain_log_likelihood(const Segment& segment, double inner_area_share,
                            const Eigen::Vector2d& projected_centre) {
  const Eigen::Vector2d outer(segment.ellipse.u, segment.ellipse.v);
  const Eigen::Vector2d expected = projected_centre + inner_area_share * (outer - projected_centre);
  const Eigen::Vector2d seen(segment.inner.u, segment.inner.v);
  const double inner_radius = std::sqrt(inner_area_share) * mean_radius(segment.ellipse);
  // A centroid averages the noise of its outline's pixels, about pi r of them in each direction.
  const double variance = kOutlineNoise * kOutlineNoise / (std::numbers::pi * inner_radius);
  return -0.5 * (seen - expected).squaredNorm() / variance;
}

// Whether it is the word that was read that stands there: codes of another length, dirt or print of
// some other kind may be read as a word, but leave more residuals inside than the outer rim has,
// which looks the same whatever is inside.
double word_credence(const std::optional<PhotometricPose>& fitted, const Segment& segment) {
  constexpr double kUsualExcess = 0.08;  // deviation inside that a right word may add, of contrast
  constexpr double kTogether = 8;        // pixels that err together
  if (!fitted || fitted->inner_pixels == 0) return 1;
  const double usual = kUsualExcess * segment.levels.contrast();
  const double ratio = fitted->inner_square / (fitted->outer_square + usual * usual);
  if (ratio <= 1) return 1;
  const double against = 0.5 * fitted->inner_pixels / kTogether * (ratio - 1 - std::log(ratio));
  constexpr double kOtherPrint = 0.05;  // beforehand
  return 1 / (1 + kOtherPrint * std::expm1(std::min(against, 50.0)));
}

}  // namespace

Observer::Observer(const DetectorParameters& parameters, std::optional<CameraModel> camera)
    : parameters_(parameters),
      camera_(camera),
      response_(parameters.response.value_or(ResponseCurve::linear())),
      fit_(response_) {
  check(parameters);
  if (parameters.bits != 0) reader_.emplace(parameters.bits, parameters.hamming);
}

// A hypothesis on its way from the outline to the refined pose.
struct Observer::Candidate {
  CirclePose circle;
  Eigen::Vector2d centre;  // of the marker, pixels
  std::optional<CodeReading> reading;
  Pattern pattern;
  PoseHypothesis hypothesis;
  std::optional<PhotometricPose> fitted;
  double behind = 0;        // in its log-likelihood, after the rough fit
  bool far_behind = false;  // so far that it was left there: `fitted` is what the rough fit found

  // Whether the fit, as far as there is one, found what a marker looks like.
  bool explained(double contrast) const {
    // A code's teeth are proof of themselves; a plain disc that nothing fits is none.
    if (!fitted) return pattern.kind != Pattern::Kind::kPlain;
    if (pattern.kind == Pattern::Kind::kPlain &&
        (fitted->state.inner_ratio < kPlainInnerRatioMin - 0.04 ||
         fitted->state.inner_ratio > kPlainInnerRatioMax + 0.04)) {
      return false;
    }
    // A disc that leaves more residuals than the outer rim is no disc: a square, say.
    // Nor is one that is of another light than the paper around: most of its pixels are
    // disbelieved.
    constexpr double kDiscError = 0.06;  // share of the contrast
    constexpr double kMinDiscTrust = 0.9;
    if (pattern.kind == Pattern::Kind::kPlain && fitted->inner_trust < kMinDiscTrust) return false;
    const double error = kDiscError * contrast;
    if (pattern.kind == Pattern::Kind::kPlain &&
        fitted->inner_square > 2 * fitted->outer_square + error * error) {
      return false;
    }
    return fitted->mean_square < kMaxResidual * kMaxResidual * contrast * contrast;
  }
};

// The ratio that was configured, unless the picture shows another print.
Pattern Observer::plain_pattern(const Segment& segment) const {
  Pattern pattern;
  pattern.kind = Pattern::Kind::kPlain;
  pattern.inner_ratio = std::sqrt(segment.bright_share);
  const double tolerance = kOtherRatio + kOtherRatioPx / mean_radius(segment.ellipse);
  if (std::abs(pattern.inner_ratio - parameters_.inner_ratio) < tolerance) {
    pattern.inner_ratio = parameters_.inner_ratio;
    pattern.inner_sigma = kPrintedRatioSigma;
  }
  return pattern;
}

void Observer::observe_with_camera(const LumaView& frame, Observation& observation) {
  const Segment& segment = observation.segment;
  const double radius_m = parameters_.diameter_m / 2;
  const auto conic = undistorted_conic(segment.ellipse, *camera_);
  if (!conic) return;
  const auto circles = circle_poses(*conic, radius_m);
  if (!circles) return;

  std::array<Candidate, 2> candidates;
  for (std::size_t i = 0; i < 2; ++i) {
    Candidate& candidate = candidates[i];
    candidate.circle = (*circles)[i];
    const Pose pose = pose_from_circle(candidate.circle, 0);
    const auto centre = camera_->project(pose.position);
    if (!centre) return;
    candidate.centre = *centre;
    if (reader_) {
      candidate.reading = reader_->read(frame, PlaneProjection(pose, radius_m, *camera_),
                                        mean_radius(segment.ellipse), segment.levels);
    }
  }
  observation.coded = candidates[0].reading || candidates[1].reading;
  observation.pose_count = 2;
  for (Candidate& candidate : candidates) {
    const auto& reading = candidate.reading;
    double yaw = 0;
    if (observation.coded) {
      constexpr double kNothingRead = -50;
      candidate.hypothesis.log_likelihood =
          reading ? -0.5 * reading->edge_scatter / (kToothEdgeNoise * kToothEdgeNoise) +
                        std::log(std::max(reading->probability, 1e-9))
                  : kNothingRead;
      // Teeth that are more likely not the word's would only mislead the fit.
      if (reading && reading->probability > 0.5) {
        yaw = reading->yaw;
        candidate.pattern.kind = Pattern::Kind::kCode;
        candidate.pattern.bits = parameters_.bits;
        candidate.pattern.word = *reader_->code().word(reading->id);
      }
    } else {
      candidate.hypothesis.log_likelihood =
          plain_log_likelihood(segment, segment.bright_share, candidate.centre);
      if (may_be_plain_centre(segment)) {
        candidate.pattern = plain_pattern(segment);
      }
    }
    candidate.hypothesis.pose = pose_from_circle(candidate.circle, yaw);
  }
  refine(frame, segment, candidates);
  const std::size_t best =
      candidates[1].hypothesis.log_likelihood > candidates[0].hypothesis.log_likelihood ? 1 : 0;
  observation.poses = {candidates[best].hypothesis, candidates[1 - best].hypothesis};
  if (candidates[best].reading && candidates[best].reading->id > 0) {
    observation.id = candidates[best].reading->id;
    observation.id_probability =
        candidates[best].reading->probability * word_credence(candidates[best].fitted, segment);
  }
  if (candidates[best].fitted && wants_curve() && curve_evidence_.wants_more()) {
    weigh_curve(frame, segment, candidates[best].hypothesis);
  }
  // A code that can be read is proof enough, whatever light or glare do to the residuals.
  const bool read = observation.id_probability >= parameters_.min_id_probability;
  observation.plausible =
      read || ((observation.coded || may_be_plain_centre(segment)) && same_paper(frame, segment) &&
               candidates[best].explained(segment.levels.contrast()));
  observation.convincing =
      read || (observation.plausible && is_clean(frame, segment, candidates[best]));
}

// Whether what has no id to prove it is as clean as a print: noise alone makes its residuals, and
// black and paper around are of one grey each.
bool Observer::is_clean(const LumaView& frame, const Segment& segment,
                        const Candidate& candidate) const {
  const auto& fitted = candidate.fitted;
  if (!fitted) return false;
  const bool plain = candidate.pattern.kind == Pattern::Kind::kPlain;
  // Teeth that are surely no word of the set may be another print's, if they are clean ones; cogs
  // and petals are not.
  constexpr double kSurelyNone = 0.05, kCleanTeeth = 0.16;
  const auto& reading = candidate.reading;
  if (!plain &&
      (!reading || (reading->probability < kSurelyNone && reading->spread > kCleanTeeth))) {
    return false;
  }
  constexpr double kMaxMarginOff = 0.1;
  const Surroundings around =
      look_around(frame, PlaneProjection(fitted->state.pose, parameters_.diameter_m / 2, *camera_),
                  plain ? fitted->state.inner_ratio : 0, fitted->state.blur_px, segment.levels);
  if (around.margin_off > kMaxMarginOff || around.ring_off > kMaxMarginOff) return false;
  constexpr double kNoiseSlack = 2;  // the noise is measured on a few pixels
  // Share of the contrast. What blur makes of a small disc the model has not quite right.
  constexpr double kMaxMisfit = 0.03, kBlurredMisfit = 1.5;
  const double blurred =
      fitted->state.blur_px / std::max(1.0, fitted->state.inner_ratio * segment.ellipse.b);
  const double misfit =
      kMaxMisfit * (1 + kBlurredMisfit * std::min(1.0, blurred)) * segment.levels.contrast();
  return std::max(fitted->outer_square, fitted->inner_square) <
         kNoiseSlack * around.noise * around.noise + misfit * misfit;
}

// Fits the candidates' poses to some of the pixels, which mostly tells already which one it is.
void Observer::fit_roughly(const Segment& segment, std::array<Candidate, 2>& candidates) {
  FitPlan plan;
  plan.unknowns = kFollowedUnknowns;
  plan.rough_every = std::clamp(fit_.loaded_pixels() / kRoughPixels, 1, kRoughEvery);
  plan.rough_steps = plan.max_steps = 3;
  plan.min_steps = 1;
  plan.settled = kRoughlySettled;
  plan.deviation = kFirstDeviation * segment.levels.contrast();
  for (std::size_t i = 0; i < 2; ++i) {
    Candidate& candidate = candidates[i];
    const double lead =
        candidates[1 - i].hypothesis.log_likelihood - candidate.hypothesis.log_likelihood;
    if (lead >= kDecided) continue;
    const EdgeLook look = edge_look(candidate.pattern);
    const PhotometricState start =
        fit_.first_guess(candidate.hypothesis.pose, segment.levels, candidate.pattern, look);
    candidate.fitted = fit_.fit(start, candidate.pattern, look, plan);
  }
  const auto &first = candidates[0].fitted, &second = candidates[1].fitted;
  if (!first || !second || candidates[0].pattern.kind != candidates[1].pattern.kind) return;
  // Near the line of sight both lead to the same pose, and one of them is enough.
  const bool same = (first->state.pose.normal() - second->state.pose.normal()).norm() < kSame;
  const double floor = kModelError * segment.levels.contrast();
  const double better = std::min(first->mean_square, second->mean_square) + floor * floor;
  for (Candidate& candidate : candidates) {
    candidate.behind = 0.5 * (candidate.fitted->mean_square + floor * floor - better) *
                       candidate.fitted->pixels / (plan.rough_every * better);
    candidate.far_behind = candidate.behind > (same ? 0 : kFarBehind);
  }
}

// Fits the candidates' poses to the grey values. Where both can be fitted the same way, how well
// they explain the picture takes the place of what their teeth or bright centres said before.
void Observer::refine(const LumaView& frame, const Segment& segment,
                      std::array<Candidate, 2>& candidates) {
  const double radius_m = parameters_.diameter_m / 2;
  const bool loaded = fit_.load(frame, *camera_, segment.ellipse, radius_m, kReach);
  if (loaded) fit_roughly(segment, candidates);
  FitPlan plan;
  plan.rough_steps = 0;
  plan.min_steps = 1;
  plan.max_steps = 5;
  plan.weigh_parts = true;
  for (std::size_t i = 0; i < 2; ++i) {
    Candidate& candidate = candidates[i];
    auto& fitted = candidate.fitted;
    PoseHypothesis& hypothesis = candidate.hypothesis;
    const EdgeLook look = edge_look(candidate.pattern);
    // What a rough fit left far behind is not fitted to all pixels as well.
    if (fitted && !candidate.far_behind) {
      plan.deviation =
          std::sqrt(fitted->mean_square) + kSecondDeviation * segment.levels.contrast();
      fitted = fit_.fit(fitted->state, candidate.pattern, look, plan);
    }
    if (fitted) {
      hypothesis.pose = fitted->state.pose;
      hypothesis.covariance = fitted->covariance;
      hypothesis.disagreement = fitted->disagreement;
      hypothesis.pattern = candidate.pattern;
      hypothesis.state = fitted->state;
      hypothesis.mean_square = fitted->mean_square;
      if (candidate.pattern.kind != Pattern::Kind::kCode) {
        hypothesis.pose = pose_from_circle({hypothesis.pose.position, hypothesis.pose.normal()}, 0);
      }
    } else {
      EdgeNoise noise;
      noise.outline_px = kOutlineNoise;
      noise.yaw_rad = kToothEdgeNoise / (0.47 * mean_radius(segment.ellipse));
      hypothesis.covariance = pose_covariance(hypothesis.pose, radius_m, *camera_, noise);
    }
  }
  const auto &first = candidates[0].fitted, &second = candidates[1].fitted;
  if (!first || !second || candidates[0].pattern.kind != candidates[1].pattern.kind) return;
  // Grey levels that even a perfect model would leave: what print and light do is not all known.
  const double floor = kModelError * segment.levels.contrast();
  const double variance = std::min(first->mean_square, second->mean_square) + floor * floor;
  for (Candidate& candidate : candidates) {
    candidate.hypothesis.log_likelihood =
        -0.5 * candidate.fitted->mean_square * candidate.fitted->pixels / variance;
  }
  // What was left behind was fitted to fewer pixels, whose residuals may happen to be smaller: only
  // what the rough fit made of both compares them.
  for (std::size_t i = 0; i < 2; ++i) {
    if (!candidates[i].far_behind) continue;
    candidates[i].hypothesis.log_likelihood =
        candidates[1 - i].hypothesis.log_likelihood - candidates[i].behind;
  }
}

// How well the marker would be explained by curves around the likeliest one.
void Observer::weigh_curve(const LumaView& frame, const Segment& segment,
                           const PoseHypothesis& hypothesis) {
  const Pattern& pattern = hypothesis.pattern;
  const EdgeLook usual = edge_look(pattern);
  if (usual.shift_sigma_px < 0.1) return;  // a shift that may not be fitted would look like a curve
  // Light is read off noisy grey levels, and noise as strong as this bends a curve by itself.
  constexpr double kMaxNoise = 0.04;  // share of the contrast
  const double limit = kMaxNoise * segment.levels.contrast();
  if (hypothesis.mean_square > limit * limit) return;
  const PhotometricState& fitted = *hypothesis.state;
  --curve_turns_;
  EdgeLook look = usual;
  look.blur_px = fitted.blur_px;
  constexpr double kStartDeviation = 0.02, kCurveError = 0.01;  // share of the contrast
  const double error = kCurveError * segment.levels.contrast();
  const double variance = hypothesis.mean_square + error * error;
  FitPlan plan;
  plan.rough_steps = 0;
  plan.max_steps = 5;
  plan.deviation = std::sqrt(hypothesis.mean_square) + kStartDeviation * segment.levels.contrast();
  std::array<double, 3> squares{};
  bool whole = true;
  for (std::size_t k = 0; k < squares.size() && whole; ++k) {
    const double exponent =
        curve_evidence_.centre() + (static_cast<double>(k) - 1) * CurveEvidence::kProbe;
    fit_.set_response(ResponseCurve::like_srgb(exponent));
    whole = fit_.load(frame, *camera_, segment.ellipse, parameters_.diameter_m / 2, kReach);
    if (!whole) break;
    PhotometricState start = fit_.first_guess(fitted.pose, segment.levels, pattern, look);
    start.stretch_u = fitted.stretch_u;
    start.stretch_d = fitted.stretch_d;
    const auto again = fit_.fit(start, pattern, look, plan);
    whole = again.has_value();
    if (whole) squares[k] = again->mean_square * again->pixels * again->trust / variance;
  }
  fit_.set_response(response_);
  if (whole) curve_evidence_.add(squares);
}

bool Observer::wants_curve() const {
  return !parameters_.response && curve_turns_ > 0;
}

bool Observer::ask_for_curve(const LumaView& frame, const Observation& followed) {
  if (!wants_curve() || curve_evidence_.is_settled()) return false;
  if (followed.pose_count > 0 && followed.poses[0].state) {
    weigh_curve(frame, followed.segment, followed.poses[0]);
  }
  return true;
}

bool Observer::settle_curve() {
  if (parameters_.response || curve_evidence_.exponent() == exponent_) return false;
  exponent_ = curve_evidence_.exponent();
  response_ = exponent_ == 1 ? ResponseCurve::linear() : ResponseCurve::like_srgb(exponent_);
  fit_.set_response(response_);
  for (PhotometricFit& fit : more_fits_) fit.set_response(response_);
  return true;
}

void Observer::forget_curve() {
  if (parameters_.response) return;
  curve_evidence_.forget();
  settle_curve();
}

Observation Observer::observe(const LumaView& frame, const Segment& segment) {
  Observation observation;
  observation.segment = segment;
  if (camera_) {
    observe_with_camera(frame, observation);
  } else if (!reader_) {
    observation.plausible = observation.convincing = may_be_plain_centre(segment);
  } else {
    // Without a camera the ring is taken for concentric with the outline: good enough for the id.
    const auto reading = reader_->read(frame, PlaneProjection(segment.ellipse),
                                       mean_radius(segment.ellipse), segment.levels);
    observation.coded = reading.has_value();
    observation.plausible = observation.convincing =
        observation.coded || may_be_plain_centre(segment);
    if (reading && reading->id > 0) {
      observation.id = reading->id;
      observation.id_probability = reading->probability;
    }
  }
  return observation;
}

Marker Observer::to_marker(const Observation& observation, int pose_index) const {
  Marker marker;
  const Ellipse& ellipse = observation.segment.ellipse;
  marker.ellipse = ellipse;
  marker.u = ellipse.u;
  marker.v = ellipse.v;
  if (observation.pose_count == 0) return marker;

  const PoseHypothesis& chosen = observation.poses[static_cast<std::size_t>(pose_index)];
  const PoseHypothesis& other = observation.poses[static_cast<std::size_t>(1 - pose_index)];
  marker.has_pose = true;
  marker.pose = chosen.pose;
  marker.has_alternative = true;
  marker.alternative = other.pose;
  marker.ambiguity = std::exp(std::min(0.0, other.log_likelihood - chosen.log_likelihood));
  if (const auto centre = camera_->project(chosen.pose.position)) {
    marker.u = centre->x();
    marker.v = centre->y();
  }
  marker.sigma_position = chosen.covariance.diagonal().head<3>().cwiseSqrt();
  marker.sigma_rotation = chosen.covariance.diagonal().tail<3>().cwiseSqrt();
  return marker;
}

}  // namespace roundel
