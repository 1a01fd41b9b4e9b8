#include "bench/accuracy/square_figure.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "simulator/pattern.hpp"

namespace roundel::bench {

namespace {

constexpr double kInstantSpacing = 0.25;  // pixels, as in the simulator
constexpr int kPieces = 8;                // of a side: the lens bends it

}  // namespace

SquareFigure::SquareFigure(const Experiment& experiment, const PlacedMarker& marker,
                           const SquarePattern& pattern)
    : camera_(experiment.camera),
      marker_(marker),
      pattern_(pattern),
      side_m_(experiment.diameter_m),
      plate_m_(experiment.diameter_m * experiment.plate_ratio),
      exposure_s_(experiment.imaging.exposure_s) {
  measure();
}

Pose SquareFigure::at(double time_s) const {
  Pose pose = marker_.pose;
  pose.position += marker_.velocity * time_s;
  const Eigen::Vector3d turn = marker_.spin * time_s;
  if (const double angle = turn.norm(); angle > 0) {
    pose.orientation =
        Eigen::Quaterniond(Eigen::AngleAxisd(angle, turn / angle)) * pose.orientation;
  }
  return pose;
}

void SquareFigure::measure() {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Eigen::Vector2d low(kInfinity, kInfinity), high = -low;
  const Pose first = at(-0.5 * exposure_s_), last = at(0.5 * exposure_s_);
  double travel = 0;
  emit_rectangle({0, 0}, plate_m_, plate_m_, kPieces, [&](const Eigen::Vector2d& p) {
    const Eigen::Vector3d corner(p.x(), p.y(), 0);
    const Eigen::Vector2d a = camera_.project(first.to_camera(corner)).value();
    const Eigen::Vector2d b = camera_.project(last.to_camera(corner)).value();
    low = low.cwiseMin(a).cwiseMin(b);
    high = high.cwiseMax(a).cwiseMax(b);
    travel = std::max(travel, (b - a).norm());
  });
  box_ = {static_cast<int>(std::floor(low.x())) - 1, static_cast<int>(std::floor(low.y())) - 1,
          static_cast<int>(std::ceil(high.x())) + 2, static_cast<int>(std::ceil(high.y())) + 2};
  instants_ = std::clamp(static_cast<int>(std::ceil(travel / kInstantSpacing)), 1, 64);
}

void SquareFigure::draw(const FineFrame& frame, double ink, CoverageGrid& base,
                        CoverageGrid& print) const {
  // Outlines run counter-clockwise on the face, which subtracts: see CoverageGrid.
  const double share = -1.0 / instants_;
  const double cell = side_m_ / pattern_.cells, edge = -0.5 * side_m_;
  for (int k = 0; k < instants_; ++k) {
    const Pose pose = at(exposure_s_ * ((k + 0.5) / instants_ - 0.5));
    draw_rectangle(pose, {0, 0}, plate_m_, plate_m_, frame, share, base);
    draw_rectangle(pose, {0, 0}, side_m_, side_m_, frame, share * ink, print);
    for (int row = 0; row < pattern_.cells; ++row) {
      for (int column = 0; column < pattern_.cells; ++column) {
        if (!pattern_.is_white(column, row)) continue;
        const int start = column;
        while (column < pattern_.cells && pattern_.is_white(column, row)) ++column;
        const double width = (column - start) * cell;
        draw_rectangle(pose, {edge + start * cell + 0.5 * width, -(edge + (row + 0.5) * cell)},
                       width, cell, frame, -share * ink, print);
      }
    }
  }
}

void SquareFigure::draw_rectangle(const Pose& pose, const Eigen::Vector2d& centre, double width,
                                  double height, const FineFrame& frame, double weight,
                                  CoverageGrid& grid) const {
  grid.begin(weight);
  emit_rectangle(centre, width, height, kPieces, [&](const Eigen::Vector2d& p) {
    const Eigen::Vector3d x = pose.to_camera({p.x(), p.y(), 0});
    const Eigen::Vector2d pixel = camera_.to_pixel(camera_.distort(x.head<2>() / x.z()));
    grid.add({(pixel.x() - frame.left + 0.5) * frame.factor,
              (pixel.y() - frame.top + 0.5) * frame.factor});
  });
  grid.end();
}

}  // namespace roundel::bench
