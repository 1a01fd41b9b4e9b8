#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/marker_geometry.hpp"
#include "core/vector_unit.hpp"

namespace roundel {

// Unknowns of the photometric fit, in the order of its normal equations: a fit may leave out those
// at the end. Motion is that of the marker in its own frame, in units of its radius and radians.
enum PhotometricUnknown {
  kMoveX,
  kMoveY,
  kMoveZ,
  kTurnX,
  kTurnY,
  kTurnZ,
  kDark,      // grey levels
  kContrast,  // grey levels
  kBlur,      // logarithm of the edge profile's standard deviation
  kShift,     // growth of dark over bright, pixels
  kFollowedUnknowns,
  kSlopeX = kFollowedUnknowns,  // of the light, share a radius
  kSlopeY,
  kStretchU,  // of the blur, as motion makes it: relative excess of its variance along u over v
  kStretchD,  // and along the diagonal u = v over the other one
  kCodeUnknowns,
  kInner = kCodeUnknowns,  // radius ratio of a plain marker's bright disc
  kPhotometricUnknowns
};

// A marker's pixels, one array a quantity (what vector units want). The length is a multiple of
// kPixelBlock; the rest is filled with pixels of no weight.
struct PixelColumns {
  const float* x = nullptr;  // normalised, lens removed, relative to the marker's middle
  const float* y = nullptr;
  const float* grey = nullptr;  // linear in the light
  const float* weight =
      nullptr;  // root of it: grey levels of noise a level of light; 0 for filling
  int count = 0;
  int every = 1;  // of so many blocks one is used: a rough step can do with a part of the marker
};
constexpr int kPixelBlock = 32;

// The model's state, in the form that the kernel wants.
struct PhotometricModel {
  // Homogeneous plane coordinates of a pixel: at + by_x * x + by_y * y; units of the outer radius.
  std::array<float, 3> at, by_x, by_y;
  std::array<float, 3> by_u, by_v;  // the same by steps of a pixel
  std::array<float, 3> eye;         // the camera in the marker frame, units of the radius
  float dark, contrast, slope_x, slope_y, blur, shift, stretch_u, stretch_d;
  // Edges are seen through boxes (a pixel's square, an even motion during the exposure), not
  // through a Gaussian of their variance: dearer, and worth it where they are much of the blur.
  bool boxed;
  float motion;  // what motion adds to the blur's variance, half of it, over the mean variance
  float inner;   // rim of the bright centre
  int halves;    // half-teeth of the code, 0 without
  // Bit k of the middle word: half-tooth k is bright; of the others: its neighbour two before, one
  // before, one after, two after.
  std::array<std::int32_t, 5> colours;
  float robust_scale;  // residuals beyond it lose weight, grey levels
  float outlier;       // residuals beyond it count for nothing
};

// The lower triangle of the normal matrix, row by row, and the rest of the normal equations. What
// belongs to unknowns that were left out stays zero.
struct PhotometricSums {
  std::array<float, kPhotometricUnknowns*(kPhotometricUnknowns + 1) / 2> normal_matrix{};
  std::array<float, kPhotometricUnknowns> right_side{};
  float squares = 0, weights = 0;  // of the weighted residuals
};

// Adds the equations of pixels on the outer rim and of those around the inner edges, for the first
// `unknowns` of the unknowns: kFollowedUnknowns, kCodeUnknowns or all.
void add_outer_pixels(const PhotometricModel& model, const PixelColumns& pixels, int unknowns,
                      PhotometricSums& sums, VectorUnit unit = VectorUnit::kBest);
void add_inner_pixels(const PhotometricModel& model, const PixelColumns& pixels, int unknowns,
                      PhotometricSums& sums, VectorUnit unit = VectorUnit::kBest);

// The same of the right side of all unknowns, squares and weights alone: the normal matrix stays as
// it is.
void add_outer_pulls(const PhotometricModel& model, const PixelColumns& pixels,
                     PhotometricSums& sums, VectorUnit unit = VectorUnit::kBest);
void add_inner_pulls(const PhotometricModel& model, const PixelColumns& pixels,
                     PhotometricSums& sums, VectorUnit unit = VectorUnit::kBest);

}  // namespace roundel
