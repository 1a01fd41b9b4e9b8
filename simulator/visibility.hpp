#pragma once

#include <Eigen/Core>
#include <array>

#include "core/camera_model.hpp"
#include "core/pose.hpp"

namespace roundel {

// The image of a flat thing's outline, as a polygon around it. Convex but for the lens's bending,
// which is far below a pixel at the size of a marker.
struct ImageOutline {
  static constexpr int kCorners = 32;
  std::array<Eigen::Vector2d, kCorners> corners;
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();  // of the corners
  double reach = 0;                                  // largest distance of a corner from it
  bool valid = false;                                // false if some of it does not project
};

ImageOutline disc_outline(const CameraModel& camera, const Pose& pose, double radius_m);
ImageOutline rectangle_outline(const CameraModel& camera, const Pose& pose, double width_m,
                               double height_m);

// Whether all of it lies within the image, at least `margin` pixels from the border.
bool inside_image(const ImageOutline& outline, int width, int height, double margin);

// Whether two outlines come closer than `margin` pixels to each other.
bool closer_than(const ImageOutline& a, const ImageOutline& b, double margin);

}  // namespace roundel
