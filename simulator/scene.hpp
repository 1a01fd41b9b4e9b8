#pragma once

#include <cstdint>
#include <numbers>
#include <vector>

#include "core/marker_geometry.hpp"
#include "core/pose.hpp"

namespace roundel {

enum class MarkerKind {
  WhyCode,  // a ring with the Manchester code of `word`
  WhyCon,   // a plain ring
  Disc,     // a black disc
};

// A printed marker on its white plate. Only the printed face is drawn: a marker seen from behind
// is not there.
struct SceneMarker {
  MarkerKind kind = MarkerKind::WhyCode;
  int bits = 8;                           // WhyCode: in [2, 16]
  std::uint32_t word = 1;                 // WhyCode: most significant bit first, from +x
  double inner_ratio = kPlainInnerRatio;  // WhyCon: white over black radius, in (0, 1)
  double diameter_m = kDefaultDiameter;   // outer black diameter
  double plate_ratio = kMarginRatio;      // plate radius over outer black radius, >= 1
  Pose pose;                              // marker in camera, at the middle of the exposure
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  // m/s, camera axes
  Eigen::Vector3d spin = Eigen::Vector3d::Zero();      // rad/s about the camera axes
};

enum class Outline { Ellipse, Rectangle };

// A flat thing of one grey, with or without a hole that is filled with another: clutter, occluders.
// It lies in the x-y plane of its pose and is seen from both sides.
struct SceneShape {
  Outline outline = Outline::Ellipse;
  double width_m = 0.1;   // along x
  double height_m = 0.1;  // along y
  double grey = 35;
  double hole_ratio = 0;  // hole size over outline size; 0 = no hole. The hole lies inside
  Outline hole = Outline::Ellipse;
  Eigen::Vector2d hole_offset_m = Eigen::Vector2d::Zero();
  double hole_grey = 215;
  Pose pose;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  // m/s, camera axes
  Eigen::Vector3d spin = Eigen::Vector3d::Zero();      // rad/s about the camera axes
};

// What is in front of the camera. Clutter is painted first, then markers, then occluders, each list
// in its order: what comes later covers what came before.
struct Scene {
  std::vector<SceneShape> clutter;
  std::vector<SceneMarker> markers;
  std::vector<SceneShape> occluders;
};

// Light, optics and sensor. Grey levels are those of the picture under the mean light, after the
// response curve; mixing at edges and blur happen in linear light.
struct Imaging {
  double black = 35;   // the marker's ink
  double white = 215;  // the marker's paper
  double floor = 120;  // the background

  double blur_px = 0;      // standard deviation of the lens's Gaussian blur, [0, 10]
  double exposure_s = 0;   // motion during it is averaged; 0 = a snapshot
  double noise_sigma = 0;  // grey levels, Gaussian, after the response curve, [0, 60]

  // Response: grey = 255 (light / 255)^(1 / gamma), or the curve of sRGB.
  double gamma = 1;  // [0.2, 5]
  bool srgb = false;

  // Light gradient: relative difference of the light between two points one image width apart
  // along `gradient_angle`; 1 in the image's middle.
  double gradient = 0;        // [-1, 1]
  double gradient_angle = 0;  // direction of growing light, from +u toward +v, radians

  // Hard-edged shadow on one side of a straight line in the image.
  double shadow_factor = 1;  // light in the shadow, [0, 1]; 1 = no shadow
  double shadow_u = 0;       // a point of the line, pixels
  double shadow_v = 0;
  double shadow_angle = 0;  // direction into the shadow, from +u toward +v, radians
};

}  // namespace roundel
