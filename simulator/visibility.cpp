#include "simulator/visibility.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "simulator/pattern.hpp"

namespace roundel {

namespace {

class OutlineBuilder {
 public:
  OutlineBuilder(const CameraModel& camera, const Pose& pose) : camera_(camera), pose_(pose) {
    outline_.valid = true;
  }
  void operator()(const Eigen::Vector2d& p) {
    if (const auto pixel = camera_.project(pose_.to_camera({p.x(), p.y(), 0}))) {
      outline_.corners[static_cast<std::size_t>(count_++)] = *pixel;
    } else {
      outline_.valid = false;
    }
  }
  ImageOutline outline() const {
    ImageOutline done = outline_;
    if (!done.valid) return done;
    for (const auto& p : done.corners) done.middle += p / ImageOutline::kCorners;
    for (const auto& p : done.corners) done.reach = std::max(done.reach, (p - done.middle).norm());
    return done;
  }

 private:
  const CameraModel& camera_;
  const Pose& pose_;
  ImageOutline outline_;
  int count_ = 0;
};

// The gap between the outlines along the normals of one of them; negative where they overlap.
double largest_gap(const ImageOutline& of, const ImageOutline& other) {
  double largest = -std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < of.corners.size(); ++k) {
    const Eigen::Vector2d along = of.corners[(k + 1) % of.corners.size()] - of.corners[k];
    const double length = along.norm();
    if (length == 0) continue;
    const Eigen::Vector2d normal = Eigen::Vector2d(along.y(), -along.x()) / length;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    double other_low = low, other_high = high;
    for (std::size_t i = 0; i < of.corners.size(); ++i) {
      const double p = normal.dot(of.corners[i]), q = normal.dot(other.corners[i]);
      low = std::min(low, p);
      high = std::max(high, p);
      other_low = std::min(other_low, q);
      other_high = std::max(other_high, q);
    }
    largest = std::max({largest, other_low - high, low - other_high});
  }
  return largest;
}

}  // namespace

ImageOutline disc_outline(const CameraModel& camera, const Pose& pose, double radius_m) {
  const double around = radius_m / std::cos(std::numbers::pi / ImageOutline::kCorners);
  OutlineBuilder builder(camera, pose);
  emit_ellipse({0, 0}, around, around, ImageOutline::kCorners,
               [&](const Eigen::Vector2d& p) { builder(p); });
  return builder.outline();
}

ImageOutline rectangle_outline(const CameraModel& camera, const Pose& pose, double width_m,
                               double height_m) {
  OutlineBuilder builder(camera, pose);
  emit_rectangle({0, 0}, width_m, height_m, ImageOutline::kCorners / 4,
                 [&](const Eigen::Vector2d& p) { builder(p); });
  return builder.outline();
}

bool inside_image(const ImageOutline& outline, int width, int height, double margin) {
  return outline.valid &&
         std::all_of(outline.corners.begin(), outline.corners.end(), [&](const auto& p) {
           return p.x() >= margin && p.y() >= margin && p.x() <= width - 1 - margin &&
                  p.y() <= height - 1 - margin;
         });
}

bool closer_than(const ImageOutline& a, const ImageOutline& b, double margin) {
  if (!a.valid || !b.valid) return false;
  if ((a.middle - b.middle).norm() > a.reach + b.reach + margin) return false;
  return std::max(largest_gap(a, b), largest_gap(b, a)) < margin;
}

}  // namespace roundel
