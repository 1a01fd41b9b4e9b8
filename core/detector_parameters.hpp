#pragma once

#include <optional>

#include "core/marker_geometry.hpp"
#include "core/response_curve.hpp"

namespace roundel {

// What the user sets; everything has a usable default. Read once, when a detector is made.
struct DetectorParameters {
  double diameter_m = kDefaultDiameter;   // outer black diameter of every marker
  int bits = 8;                           // WhyCode bits; 0 = plain WhyCon markers only
  double inner_ratio = kPlainInnerRatio;  // of plain markers: white disc over black one; 0: unknown
  int hamming = 1;                        // minimum Hamming distance of the id set
  int max_markers = 1000;                 // more are not reported
  std::optional<ResponseCurve> response;  // of the camera; none: as the markers tell

  int min_diameter_px = 12;             // of the marker's outline: mean of its axes; a slanted
                                        // one may be a quarter less across its shorter side
  int max_diameter_px = 1200;           // across its longer side
  int min_contrast = 20;                // grey levels between dark and bright
  double circularity_tolerance = 0.02;  // relative, area of the moment ellipse against pixels, plus
                                        // the share that the pixel grid explains
  double area_ratio_tolerance = 0.40;   // relative, dark area : bright area
  double concentricity_tolerance = 0.10;    // offset of the bright part, share of the box
  double concentricity_tolerance_px = 1.0;  // the same, absolute
  double min_id_probability = 0.9;          // below it the id is reported as -1
};

}  // namespace roundel
