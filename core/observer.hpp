#pragma once

#include <array>
#include <limits>
#include <optional>
#include <vector>

#include "core/camera_model.hpp"
#include "core/code_reader.hpp"
#include "core/curve_evidence.hpp"
#include "core/detector_parameters.hpp"
#include "core/luma_view.hpp"
#include "core/marker.hpp"
#include "core/photometric_fit.hpp"
#include "core/segment.hpp"

namespace roundel {

// One of the two poses that a marker's outline allows, and what speaks for it.
struct PoseHypothesis {
  Pose pose;
  PoseCovariance covariance = PoseCovariance::Zero();
  PoseCovariance disagreement = PoseCovariance::Zero();  // its part that no noise explains
  double log_likelihood = 0;              // of what was seen; comparable within a marker
  Pattern pattern;                        // that it was fitted with
  std::optional<PhotometricState> state;  // of the fit, if there was one
  double mean_square = 0;                 // of the fit's residuals, grey levels squared
};

// A marker as one frame shows it, before a track adds what earlier frames showed.
struct Observation {
  Segment segment;
  int id = -1;                // read in this frame; -1: none or not readable
  double id_probability = 0;  // given this frame alone
  bool coded = false;         // a code ring was seen, whether or not its id is in the set
  bool plausible = false;  // what lies inside is a code, a plain marker's disc or too small to tell
  bool convincing = false;  // so much like a marker that this frame alone is proof of one
  bool followed = false;    // fitted from what the track knew: no new reading, no weighing
  bool disturbed = false;   // followed where something lies over it or its light is not even
  bool lit_anew = true;     // the slope of the light was fitted
  double surprise_px = 0;   // of a followed one: how far from the expected place it was
  int pose_count = 0;       // 0 without a camera model, else 2
  std::array<PoseHypothesis, 2> poses;  // the likelier one first
};

// Where the marker of a track is expected, and how bright.
struct Expectation {
  Pose pose;
  Ellipse ellipse;  // its outline: as seen, or that of the pose
  Levels levels;
  bool close = false;         // so close that the fit's first step may be its last
  bool in_new_light = false;  // light and motion blur are fitted along
};

// Turns segments into observations: two poses from the outline, the code or the bright centre read
// under both, both refined on the grey values, the likelier one first (METHOD.md sections 3 to 6).
class Observer {
 public:
  // Throws std::invalid_argument for parameters out of range.
  Observer(const DetectorParameters& parameters, std::optional<CameraModel> camera);

  const std::optional<CameraModel>& camera() const { return camera_; }
  int id_count() const { return reader_ ? reader_->code().id_count() : 0; }

  Observation observe(const LumaView& frame, const Segment& segment);

  // The marker of a track that is sure of its id and its pose: a single fit from where the last
  // observation leads to expect it, with nothing read or weighed anew. Nothing when the picture
  // does not bear it out. Several workers, by their numbers, may do so at a time.
  std::optional<Observation> follow(const LumaView& frame, const PoseHypothesis& last,
                                    const Expectation& expected, int worker = 0);

  // The marker of a track whose word is known, where something lies over it or its light is not
  // even: fitted from where it is expected to what of it can be believed, for as long as that is
  // most of it. Of the id it says what can still be read. Nothing when the picture does not bear it
  // out.
  std::optional<Observation> follow_disturbed(const LumaView& frame, const PoseHypothesis& last,
                                              const Expectation& expected);

  // From now on follow() may be called by so many workers; never by less than before.
  void make_room_for(int workers);

  // Moves a pose aside by as much as its outline moved. False where the lens model ends.
  bool move(Pose& pose, const Ellipse& from, const Ellipse& to) const;

  // A pose's image; nothing where it has none.
  std::optional<Ellipse> outline(const Pose& pose) const;

  // Asks no more than so many markers for the camera's curve until this is said again: each costs
  // as much as three fits.
  void limit_curve_turns(int markers) { curve_turns_ = markers; }
  // Asks a followed marker. False when no further one need be asked.
  bool ask_for_curve(const LumaView& frame, const Observation& followed);
  // Takes the response curve for what the markers observed so far tell, if that has changed.
  bool settle_curve();
  // Back to knowing nothing of the curve, unless it was given.
  void forget_curve();

  // The observation as users get it, with the given one of its poses; id and track are the
  // caller's.
  Marker to_marker(const Observation& observation, int pose_index) const;

 private:
  // Residuals that no noise explains, share of the contrast.
  static constexpr double kModelError = 0.01;

  struct Candidate;
  Pattern plain_pattern(const Segment& segment) const;
  void observe_with_camera(const LumaView& frame, Observation& observation);
  void fit_roughly(const Segment& segment, std::array<Candidate, 2>& candidates);
  bool is_clean(const LumaView& frame, const Segment& segment, const Candidate& candidate) const;
  void refine(const LumaView& frame, const Segment& segment, std::array<Candidate, 2>& candidates);

  static Observation followed(const Pattern& pattern, const Expectation& expected,
                              const PhotometricPose& fitted);
  static PhotometricState start_from(const PoseHypothesis& last, const Pose& expected);

  bool wants_curve() const;
  void weigh_curve(const LumaView& frame, const Segment& segment, const PoseHypothesis& hypothesis);

  DetectorParameters parameters_;
  std::optional<CameraModel> camera_;
  std::optional<CodeReader> reader_;  // none when bits is 0
  ResponseCurve response_;            // in use
  double exponent_ = 1;               // of it, where it was not given
  CurveEvidence curve_evidence_;
  int curve_turns_ = std::numeric_limits<int>::max();  // markers that are still to be asked
  PhotometricFit fit_;
  std::vector<PhotometricFit> more_fits_;  // of workers other than 0
};

}  // namespace roundel
