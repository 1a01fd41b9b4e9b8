#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "core/camera_model.hpp"
#include "simulator/coverage.hpp"
#include "simulator/response.hpp"
#include "simulator/scene.hpp"

namespace roundel {

// A range of pixels, half-open: [left, right) x [top, bottom).
struct PixelRange {
  int left = 0, top = 0, right = 0, bottom = 0;

  int width() const { return right - left; }
  int height() const { return bottom - top; }
  bool empty() const { return left >= right || top >= bottom; }
  PixelRange grown(int by) const { return {left - by, top - by, right + by, bottom + by}; }
  PixelRange intersection(const PixelRange& other) const;
  PixelRange hull(const PixelRange& other) const;
  bool operator==(const PixelRange&) const = default;
};

// Where a window of the fine drawing grid lies: pixel (u, v) has its centre at
// ((u - left) + 1/2) * factor in grid cells.
struct FineFrame {
  int left = 0, top = 0;  // pixels
  int factor = 1;         // cells a pixel
};

// A marker or a shape, ready to be drawn: a flat opaque base and what is printed on it, at the
// places that it takes during the exposure. Invariant: if visible(), every outline projects into
// the camera at every instant of the exposure.
class Figure {
 public:
  Figure() = default;
  // Throw std::invalid_argument when the thing cannot exist.
  Figure(const SceneMarker& marker, const Imaging& imaging, const Response& response,
         const CameraModel& camera);
  Figure(const SceneShape& shape, const Imaging& imaging, const Response& response,
         const CameraModel& camera);

  bool visible() const { return visible_; }
  const PixelRange& box() const {
    return box_;
  }  // pixels that it touches; may reach outside of the image
  float base_light() const { return base_.light; }

  // Adds the base's coverage to `base` and the print's light, relative to the base's, to `print`.
  void draw(const CameraModel& camera, const FineFrame& frame, CoverageGrid& base,
            CoverageGrid& print) const;

  // Whether both draw the same.
  bool operator==(const Figure& other) const;

 private:
  struct Layer {
    Outline outline = Outline::Ellipse;
    double centre_x = 0, centre_y = 0;  // metres, in the figure's plane
    double width = 0, height = 0;       // metres
    float light = 0;                    // of the base; of the print: step from what lies under it
    bool operator==(const Layer&) const = default;
  };
  struct Instant {  // plane to camera: origin + x * x_axis + y * y_axis
    Eigen::Vector3d origin, x_axis, y_axis;
  };

  void place(const Pose& pose, const Eigen::Vector3d& velocity, const Eigen::Vector3d& spin,
             double exposure_s, const CameraModel& camera);
  bool measure(const CameraModel& camera);
  Instant at(double time_s) const;
  static Eigen::Vector2d on_grid(const Eigen::Vector2d& p, const Instant& instant,
                                 const CameraModel& camera, const FineFrame& frame);
  void draw_layer(const Layer& layer, const Instant& instant, const CameraModel& camera,
                  const FineFrame& frame, double weight, CoverageGrid& grid) const;

  Layer base_;
  std::array<Layer, 2> print_;
  int print_count_ = 0;
  int bits_ = 0;  // 0: no code
  std::uint32_t word_ = 0;
  double code_radius_ = 0;
  float code_light_ = 0;

  Pose pose_;
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero(), spin_ = Eigen::Vector3d::Zero();
  double exposure_s_ = 0;

  bool visible_ = false;
  double facing_ = 1;        // -1 when seen from behind: outlines run the other way
  double pixels_per_m_ = 0;  // an upper bound of the magnification
  int instants_ = 1;         // that stand for the exposure
  PixelRange box_;
};

}  // namespace roundel
