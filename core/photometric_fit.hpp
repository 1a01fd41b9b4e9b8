#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/camera_model.hpp"
#include "core/covariance.hpp"
#include "core/luma_view.hpp"
#include "core/photometric_kernel.hpp"
#include "core/pose.hpp"
#include "core/segment.hpp"

namespace roundel {

// What lies inside the dark ring, as far as it is known.
struct Pattern {
  enum class Kind {
    kCode,    // the teeth of a word
    kPlain,   // a white disc; its ratio is fitted
    kUnknown  // only the outer rim is used
  };
  Kind kind = Kind::kUnknown;
  int bits = 0;
  std::uint32_t word = 0;  // canonical; starts at the pose's x axis
  double inner_ratio = 0;  // first guess, kPlain
};

// How edges look in this image, as far as it is known from elsewhere.
struct EdgeLook {
  double blur_px = 0.8;  // standard deviation of the edge profile, the pixel's own width included
  double blur_factor = 2.0;  // one standard deviation of it is a factor of so much
  double shift_px = 0;       // growth of dark over bright
  double shift_sigma_px = 0.3;
};

// A pose fitted to the grey values.
struct PhotometricPose {
  Pose pose;
  PoseCovariance covariance = PoseCovariance::Zero();
  double mean_square = 0;  // of the residuals, grey levels squared
  int pixels = 0;          // that the fit used
  Levels levels;
  double blur_px = 0;
  double edge_shift_px = 0;
  double inner_ratio = 0;  // kPlain
};

// Fits a marker's pose to the grey values of its image (METHOD.md section 6): every pixel near an
// edge is mapped into the marker's plane, and the grey expected there is dark or bright on either
// side of the rims and teeth, blended across each edge by the blur. Unknown are the pose, the two
// levels, a slope of the light, the blur and a common shift of all edges that blur, gamma or ink
// may cause. Gauss-Newton with analytic derivatives; pixels that no marker explains (glare,
// occlusion) lose their weight. Working memory is kept from call to call.
class PhotometricFit {
 public:
  // Takes the pixels of the marker under an ellipse. False when there are too few or the lens model
  // ends.
  bool load(const LumaView& frame, const CameraModel& camera, const Ellipse& ellipse,
            const Levels& levels, double radius_m);

  // The loaded marker's pose, from a start within about a pixel of it, in at most max_steps steps.
  // Nothing when it diverges.
  std::optional<PhotometricPose> fit(const Pose& start, const Pattern& pattern,
                                     const EdgeLook& look, int max_steps);

 private:
  static constexpr int kUnknowns = kPhotometricUnknowns;
  using Vector = Eigen::Matrix<double, kUnknowns, 1>;
  using Matrix = Eigen::Matrix<double, kUnknowns, kUnknowns>;

  struct Columns {
    std::vector<float> x, y, grey, weight;
    int used = 0;
    void clear();
    void add(double px, double py, double level);
    void fill_up();
    PixelColumns view() const;
  };
  struct State {
    Pose pose;
    double dark = 0, contrast = 0, slope_x = 0, slope_y = 0, blur = 0, shift = 0, inner = 0;
  };

  PhotometricModel model_of(const State& state, const Pattern& pattern, double deviation) const;
  void add_priors(const State& state, const Pattern& pattern, const EdgeLook& look, double variance,
                  Matrix& normal_matrix, Vector& right_side) const;
  State advanced(const State& state, const Vector& step) const;
  PoseCovariance covariance_of(const State& state, const Matrix& inverse) const;

  Columns outer_, inner_;
  Eigen::Vector2d middle_;       // of the marker, normalised
  Eigen::Matrix2d pixel_slope_;  // d(normalised)/d(pixel) there
  double radius_m_ = 0, radius_px_ = 0;
  Levels levels_;
};

}  // namespace roundel
