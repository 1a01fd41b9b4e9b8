#pragma once

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "calibration/arena_calibrator.hpp"
#include "core/camera_model.hpp"
#include "core/marker.hpp"
#include "tests/random.hpp"

namespace roundel::test {

// Markers as a camera above an arena would report them, with a little noise, without pictures.
class ArenaScene {
 public:
  explicit ArenaScene(double turn = 0, double tilt = 0.1) : random_(7) {
    camera_.width = 1920;
    camera_.height = 1080;
    camera_.fx = camera_.fy = 1000;
    camera_.cx = 959.5;
    camera_.cy = 539.5;
    camera_.distortion = {-0.2, 0.05, 0.0005, -0.0005, 0};
    look(turn, tilt);
  }

  const CameraModel& camera() const { return camera_; }
  const Pose& arena_in_camera() const { return arena_in_camera_; }
  ArenaCamera arena_camera() const { return {"test camera", "", camera_}; }

  // Turned about the optical axis and tilted; the arena's middle (1.5, 1) stays in the middle.
  void look(double turn, double tilt) {
    const Eigen::Quaterniond down(0, 1, 0, 0);
    const Eigen::Quaterniond q = Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()) *
                                 Eigen::AngleAxisd(tilt, Eigen::Vector3d::UnitX()) * down;
    arena_in_camera_.orientation = with_positive_w(q.normalized());
    arena_in_camera_.position = Eigen::Vector3d(0, 0, 3) - q * Eigen::Vector3d(1.5, 1, 0);
  }
  void push(const Eigen::Vector3d& by) { arena_in_camera_.position += by; }

  // A marker flat at a place of the arena, its x axis turned by `heading`.
  Marker marker(int id, const Eigen::Vector3d& place, double heading = 0) {
    Marker marker;
    marker.id = id;
    marker.id_probability = id < 0 ? 0 : 1;
    marker.has_pose = true;
    marker.pose.position = arena_in_camera_.to_camera(place);
    marker.pose.orientation =
        with_positive_w((arena_in_camera_.orientation *
                         Eigen::Quaterniond(Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ())))
                            .normalized());
    const double distance = marker.pose.position.norm();
    const double across = 0.00002;  // metres
    marker.pose.position += across * Eigen::Vector3d(random_.gaussian(), random_.gaussian(), 0);
    marker.pose.position *= 1 + 0.0003 * random_.gaussian();  // along the ray
    const Eigen::Vector2d pixel = camera_.project(marker.pose.position).value();
    marker.u = pixel.x();
    marker.v = pixel.y();
    const double radius = 0.061 / distance * camera_.fx;
    marker.ellipse = {marker.u, marker.v, radius, radius, 0};
    marker.sigma_position = {0.0001, 0.0001, 0.001};
    marker.sigma_rotation = {0.01, 0.01, 0.002};
    return marker;
  }

  // The corners of 3 m x 2 m, counter-clockwise from the origin.
  static std::vector<Eigen::Vector3d> corners(double width = 3, double height = 2) {
    return {{0, 0, 0}, {width, 0, 0}, {width, height, 0}, {0, height, 0}};
  }

 private:
  CameraModel camera_;
  Pose arena_in_camera_;
  Random random_;
};

// Four plain corners.
inline std::vector<Marker> plain_corners(ArenaScene& scene) {
  std::vector<Marker> markers;
  for (const Eigen::Vector3d& place : ArenaScene::corners()) {
    markers.push_back(scene.marker(-1, place));
  }
  return markers;
}

inline ArenaRequest three_by_two() {
  ArenaRequest request;
  request.width_m = 3;
  request.height_m = 2;
  return request;
}

constexpr double kDiameter = 0.122;

// Shows the frames that `frame_markers(number)` makes.
template <typename FrameMarkers>
ArenaCalibrator shown(const ArenaScene& scene, const ArenaRequest& request,
                      FrameMarkers&& frame_markers, int frames = 40) {
  ArenaCalibrator calibrator(request, scene.arena_camera(), kDiameter);
  for (int i = 0; i < frames; ++i) calibrator.add(frame_markers(i));
  return calibrator;
}

inline ArenaCalibration calibrated(ArenaScene& scene) {
  return shown(scene, three_by_two(), [&](int) { return plain_corners(scene); }).result();
}

// How far apart two arena frames put the same point of the floor, at most, metres.
inline double difference(const Pose& a, const Pose& b) {
  double most = 0;
  for (const Eigen::Vector3d& place : ArenaScene::corners()) {
    most = std::max(most, (a.to_camera(place) - b.to_camera(place)).norm());
  }
  return most;
}

}  // namespace roundel::test
