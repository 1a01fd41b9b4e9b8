#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "bench/common/print.hpp"
#include "simulator/pattern.hpp"

namespace roundel::bench {

namespace {

constexpr double kInstantSpacing = 0.25;  // pixels, as in the simulator
constexpr int kMaxInstants = 64;
constexpr int kPieces = 8;  // of a side: the lens bends it

// A square tag on a square plate, as roundel::Figure is a round one: exact area coverage, averaged
// over the places that it takes during the exposure. It must be in front of the camera and face it.
class SquareFigure {
 public:
  SquareFigure(const Experiment& experiment, const PlacedMarker& marker, double exposure_s,
               double ink, const SquarePattern& pattern)
      : camera_(experiment.camera),
        marker_(marker),
        pattern_(pattern),
        side_m_(experiment.diameter_m),
        plate_m_(experiment.diameter_m * experiment.plate_ratio),
        exposure_s_(exposure_s),
        ink_(ink) {
    measure();
  }

  const PixelRange& box() const { return box_; }

  void draw(const FineFrame& frame, CoverageGrid& base, CoverageGrid& print) const {
    for (int k = 0; k < instants_; ++k) {
      draw_at(at(exposure_s_ * ((k + 0.5) / instants_ - 0.5)), frame, base, print);
    }
  }

 private:
  Pose at(double time_s) const;
  void measure();
  void draw_at(const Pose& pose, const FineFrame& frame, CoverageGrid& base,
               CoverageGrid& print) const;
  void draw_rectangle(const Pose& pose, const Eigen::Vector2d& centre, double width, double height,
                      const FineFrame& frame, double weight, CoverageGrid& grid) const;

  const CameraModel& camera_;
  PlacedMarker marker_;
  const SquarePattern& pattern_;
  double side_m_, plate_m_, exposure_s_;
  double ink_;  // light, relative to the plate's
  int instants_ = 1;
  PixelRange box_;
};

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
  instants_ = std::clamp(static_cast<int>(std::ceil(travel / kInstantSpacing)), 1, kMaxInstants);
}

void SquareFigure::draw_at(const Pose& pose, const FineFrame& frame, CoverageGrid& base,
                           CoverageGrid& print) const {
  // Outlines run counter-clockwise on the face, which subtracts: see CoverageGrid.
  const double share = -1.0 / instants_;
  draw_rectangle(pose, {0, 0}, plate_m_, plate_m_, frame, share, base);
  draw_rectangle(pose, {0, 0}, side_m_, side_m_, frame, share * ink_, print);
  // White cells add up exactly with their neighbours, so a row's runs are drawn as one each.
  const double cell = side_m_ / pattern_.cells, edge = -0.5 * side_m_;
  for (int row = 0; row < pattern_.cells; ++row) {
    const double y = -(edge + (row + 0.5) * cell);
    for (int column = 0; column < pattern_.cells;) {
      const int start = column;
      while (column < pattern_.cells && pattern_.is_white(column, row)) ++column;
      const double width = (column - start) * cell;
      if (width > 0) {
        draw_rectangle(pose, {edge + start * cell + 0.5 * width, y}, width, cell, frame,
                       -share * ink_, print);
      } else {
        ++column;
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

}  // namespace

Print square_print(const Experiment& experiment, std::vector<SquarePattern> patterns) {
  const auto shared = std::make_shared<const std::vector<SquarePattern>>(std::move(patterns));
  return [&experiment, shared](const Imaging& imaging, const Response& response,
                               const PlacedMarker& placed) -> Drawing {
    const double white = response.light_of_grey(imaging.white);
    const double ink = response.light_of_grey(imaging.black) - white;
    const auto figure = std::make_shared<const SquareFigure>(
        experiment, placed, imaging.exposure_s, ink,
        (*shared)[static_cast<std::size_t>(placed.number) % shared->size()]);
    // The pattern is borrowed: the drawing keeps it.
    return {figure->box(), static_cast<float>(white),
            [figure, shared](const FineFrame& frame, CoverageGrid& base, CoverageGrid& print) {
              figure->draw(frame, base, print);
            }};
  };
}

}  // namespace roundel::bench
