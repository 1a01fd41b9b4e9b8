#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/camera_model.hpp"
#include "core/lens_patch.hpp"
#include "core/luma_view.hpp"
#include "core/marker.hpp"
#include "core/marker_geometry.hpp"
#include "core/photometric_kernel.hpp"
#include "core/response_curve.hpp"
#include "core/shadow_edge.hpp"

namespace roundel {

// Where a pattern has edges inside of the outer rim, in shares of the radius.
struct InnerEdges {
  double low = kPlainInnerRatioMin, high = kCodeOuterRatio;
};

// The pixels of a marker's image that lie near an edge of its pattern, with the lens and the
// response curve taken out: those on the outer rim and those around the inner edges. What is flat
// tells nothing new. Memory is kept from marker to marker.
class MarkerPixels {
 public:
  // Takes the pixels within `reach_px` of where a marker under `ellipse` has edges. False when
  // there are too few or where the lens model ends.
  bool load(const LumaView& frame, const CameraModel& camera, const ResponseCurve& response,
            const Ellipse& ellipse, double reach_px, const InnerEdges& inner = {});

  // Gives what lies in a shadow the light of what does not; what may be either counts for nothing.
  void relight(const ShadowEdge& edge);

  PixelColumns outer() const { return outer_.view(); }
  PixelColumns inner() const { return inner_.view(); }
  int outer_count() const { return outer_.used; }  // filling not counted
  int inner_count() const { return inner_.used; }

  // Normalised point that the columns are relative to, and d(normalised)/d(pixel) there.
  const Eigen::Vector2d& middle() const { return middle_; }
  const Eigen::Matrix2d& pixel_slope() const { return pixel_slope_; }

 private:
  struct Columns {
    std::vector<float> x, y, grey, weight;  // x and y are offsets in pixels at first
    std::vector<std::uint8_t> luma;
    int used = 0;
    void make_room(int more);
    void finish(const LensPatch& patch, const ResponseCurve& response);
    PixelColumns view() const;
  };
  struct Row;

  // Appends the pixels u0, u0 + stride, ... up to u1 of a row.
  static void take(const Row& row, int u0, int u1, int stride, Columns& columns);

  void relight(const ShadowEdge& edge, Columns& columns) const;

  Columns outer_, inner_;
  Eigen::Vector2d centre_ = Eigen::Vector2d::Zero();  // pixel of the middle
  Eigen::Vector2d middle_ = Eigen::Vector2d::Zero();
  Eigen::Matrix2d pixel_slope_ = Eigen::Matrix2d::Identity();
};

}  // namespace roundel
