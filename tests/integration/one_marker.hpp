#pragma once

#include <Eigen/Geometry>
#include <numbers>

#include "core/necklace.hpp"
#include "core/plane_projection.hpp"
#include "simulator/renderer.hpp"
#include "tests/pinhole.hpp"

// One WhyCode marker before a small camera, for tests of what disturbs it.
namespace roundel::one_marker {

inline constexpr int kId = 5, kBits = 8;
inline constexpr double kDiameter = 0.084, kFocal = 920;
inline constexpr double kDegree = std::numbers::pi / 180;

inline CameraModel camera(int width = 320, int height = 240) {
  return test::pinhole(width, height, kFocal);
}

// `incidence`: of the line of sight on the printed face; `axis_turn`: which way it is tilted.
inline SceneMarker marker_at(const Eigen::Vector3d& centre, double incidence,
                             double diameter_m = kDiameter, double axis_turn = 0.8) {
  SceneMarker marker;
  marker.bits = kBits;
  marker.word = NecklaceCode(kBits, 1).word(kId).value();
  marker.diameter_m = diameter_m;
  const Eigen::Vector3d ray = -centre.normalized();
  const Eigen::Vector3d axis = Eigen::AngleAxisd(axis_turn, ray) * ray.unitOrthogonal();
  marker.pose = pose_from_circle({centre, Eigen::AngleAxisd(incidence, axis) * ray}, 0.6);
  return marker;
}

// The distance from which a marker of the usual size is so many pixels across.
inline double distance_for(double diameter_px) {
  return kDiameter * kFocal / diameter_px;
}

inline Imaging imaging(double blur_px, double noise_sigma) {
  return {.black = 35, .white = 215, .floor = 120, .blur_px = blur_px, .noise_sigma = noise_sigma};
}

inline Scene scene_of(const SceneMarker& marker) {
  Scene scene;
  scene.markers.push_back(marker);
  return scene;
}

}  // namespace roundel::one_marker
