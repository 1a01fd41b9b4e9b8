#pragma once

#include "bench/accuracy/experiment.hpp"
#include "bench/accuracy/square_pattern.hpp"
#include "simulator/coverage.hpp"
#include "simulator/figure.hpp"

namespace roundel::bench {

// What roundel::Figure is for circular markers: a square tag on a square plate, drawn by exact area
// coverage at the places that it takes during the exposure. Print's light is relative to the
// plate's: `ink` (negative) where the tag is black, 0 where it is white.
class SquareFigure {
 public:
  // Borrows experiment and pattern. The marker must be in front of the camera and face it.
  SquareFigure(const Experiment& experiment, const PlacedMarker& marker,
               const SquarePattern& pattern);

  const Box& box() const { return box_; }
  void draw(const FineFrame& frame, double ink, CoverageGrid& base, CoverageGrid& print) const;

 private:
  Pose at(double time_s) const;
  void measure();
  void draw_rectangle(const Pose& pose, const Eigen::Vector2d& centre, double width, double height,
                      const FineFrame& frame, double weight, CoverageGrid& grid) const;

  const CameraModel& camera_;
  const PlacedMarker& marker_;
  const SquarePattern& pattern_;
  double side_m_, plate_m_, exposure_s_;
  int instants_ = 1;
  Box box_;
};

}  // namespace roundel::bench
