#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <optional>

#include "core/camera_model.hpp"
#include "core/covariance.hpp"
#include "core/luma_view.hpp"
#include "core/marker_pixels.hpp"
#include "core/photometric_kernel.hpp"
#include "core/pose.hpp"
#include "core/response_curve.hpp"
#include "core/segment.hpp"

namespace roundel {

// What lies inside the dark ring, as far as it is known.
struct Pattern {
  enum class Kind {
    kCode,    // the teeth of a word
    kPlain,   // a white disc
    kUnknown  // only the outer rim is used
  };
  Kind kind = Kind::kUnknown;
  int bits = 0;
  std::uint32_t word = 0;  // canonical; starts at the pose's x axis
  double inner_ratio = 0;  // kPlain: as far as it is known, and one standard deviation
  double inner_sigma = 0.1;
};

// How edges look in this image, as far as it is known from elsewhere.
struct EdgeLook {
  double blur_px = 0.8;  // standard deviation of the edge profile, the pixel's own width included
  double blur_factor = 2.0;  // one standard deviation of it is a factor of so much
  double shift_px = 0;       // growth of dark over bright
  double shift_sigma_px = 0.3;
};

// With an unknown inner ratio, or without anything known inside, a shift of all edges looks like
// another distance: then it is taken for small.
EdgeLook edge_look(const Pattern& pattern);

// Everything that the picture of a marker depends on.
struct PhotometricState {
  Pose pose;
  double dark = 0, contrast = 0;  // light, 0 to 255; bright less dark
  double blur_px = 0, shift_px = 0;
  double slope_x = 0, slope_y = 0;      // of the light, share a radius, marker axes
  double stretch_u = 0, stretch_d = 0;  // of the blur (kStretchU, kStretchD)
  double inner_ratio = 0;               // kPlain
};

// Where a fit starts and how far it goes.
struct FitPlan {
  int unknowns = kPhotometricUnknowns;  // kFollowedUnknowns keeps the others as they are
  double deviation = 0;  // of the residuals, grey levels, as far as it can be foreseen
  // And as which they count after the first step at most: what is more is something else.
  double max_deviation = std::numeric_limits<double>::infinity();
  int rough_steps = 1;  // first ones, that use one of `rough_every` blocks of pixels
  int rough_every = 2;
  int min_steps = 2, max_steps = 6;
  // The last step is one that leaves less than so many standard deviations.
  double settled = 0.03;
  // The covariance takes in that parts of the marker may disagree: that costs one step more.
  bool weigh_parts = false;
};

// A pose fitted to the grey values.
struct PhotometricPose {
  PhotometricState state;
  PoseCovariance covariance = PoseCovariance::Zero();
  PoseCovariance disagreement = PoseCovariance::Zero();  // what of it no noise explains
  double mean_square = 0;                                // of the residuals, grey levels squared
  int pixels = 0;                                        // that the fit used
  double outer_square = 0, inner_square = 0;  // the same of the outer rim, and of what is inside
  int inner_pixels = 0;
  double trust = 0;        // share of them that it believed: the rest looks like something else
  double inner_trust = 0;  // the same of what is inside
};

// Fits a marker's pose to the grey values of its image (METHOD.md section 6): every pixel near an
// edge is mapped into the marker's plane, and the grey expected there is dark or bright on either
// side of the rims and teeth, blended across each edge by the blur. Unknown are the pose, the two
// levels, a slope of the light, the blur, its stretch by motion and a common shift of all edges
// that gamma or ink may cause. Gauss-Newton with analytic derivatives; pixels that no marker
// explains (glare, occlusion) lose their weight. Working memory is kept from call to call.
class PhotometricFit {
 public:
  explicit PhotometricFit(const ResponseCurve& response) : response_(response) {}

  // What is loaded from now on is seen through another curve.
  void set_response(const ResponseCurve& response) { response_ = response; }

  // Takes the pixels near the edges of the marker under an ellipse, `reach_px` to either side.
  // False when there are too few or the lens model ends.
  bool load(const LumaView& frame, const CameraModel& camera, const Ellipse& ellipse,
            double radius_m, double reach_px, const InnerEdges& inner = {});

  // The same pixels with a shadow taken off them.
  void relight(const ShadowEdge& edge) { pixels_.relight(edge); }

  int loaded_pixels() const { return pixels_.outer_count() + pixels_.inner_count(); }

  // Dark and contrast as the fit counts them.
  void set_levels(const Levels& levels, PhotometricState& state) const;

  // A state to start from when nothing but a rough pose and the levels of the segment are known.
  PhotometricState first_guess(const Pose& pose, const Levels& levels, const Pattern& pattern,
                               const EdgeLook& look) const;

  // The loaded marker's pose, from a start within about a pixel of it. Nothing when it diverges.
  std::optional<PhotometricPose> fit(const PhotometricState& start, const Pattern& pattern,
                                     const EdgeLook& look, const FitPlan& plan);

 private:
  static constexpr int kUnknowns = kPhotometricUnknowns;
  using Vector = Eigen::Matrix<double, kUnknowns, 1>;

  struct Step;
  template <int kCount>
  Step solve(const PhotometricState& state, const Pattern& pattern, const EdgeLook& look,
             const PhotometricSums& sums, const FitPlan& plan, int taken) const;
  PhotometricModel model_of(const PhotometricState& state, const Pattern& pattern,
                            double deviation) const;
  PhotometricState advanced(const PhotometricState& state, const Vector& step) const;
  PoseCovariance parts_covariance(const PhotometricModel& model, bool inside,
                                  const Step& step) const;
  PoseCovariance to_camera_axes(const PhotometricState& state, const PoseCovariance& inverse) const;

  ResponseCurve response_;
  MarkerPixels pixels_;
  double radius_m_ = 0;
};

}  // namespace roundel
