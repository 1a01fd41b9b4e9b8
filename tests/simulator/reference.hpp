#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "core/camera_model.hpp"
#include "core/grey_image.hpp"
#include "simulator/scene.hpp"
#include "tests/pinhole.hpp"

// What the tests compare the simulator with. Nothing here calls the simulator: the lens formula,
// the outline and the printed pattern are written out again, and pictures are taken the other way
// round (from the pixel to the plane, point by point).
namespace reference {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Facing the camera squarely and upright: x right, y up in the image, z toward the camera.
inline Eigen::Quaterniond facing() {
  return {0, 1, 0, 0};
}

inline Eigen::Quaterniond turned(double tilt, double tilt_direction, double yaw) {
  const Vector3d axis(std::cos(tilt_direction), std::sin(tilt_direction), 0);
  return Eigen::Quaterniond(Eigen::AngleAxisd(tilt, axis)) * facing() *
         Eigen::Quaterniond(Eigen::AngleAxisd(yaw, Vector3d::UnitZ()));
}

using roundel::test::pinhole;

inline roundel::CameraModel webcam() {
  roundel::CameraModel camera = pinhole(1920, 1080, 1452);
  camera.fy = 1455;
  camera.distortion = {-0.28, 0.09, 0.0006, -0.0009, -0.012};
  return camera;
}

// The plumb-bob model as OpenCV documents it.
inline Vector2d project(const roundel::CameraModel& c, const Vector3d& p) {
  const double x = p.x() / p.z(), y = p.y() / p.z(), r2 = x * x + y * y;
  const auto& d = c.distortion;
  const double radial = 1 + d.k1 * r2 + d.k2 * r2 * r2 + d.k3 * r2 * r2 * r2;
  const double xd = x * radial + 2 * d.p1 * x * y + d.p2 * (r2 + 2 * x * x);
  const double yd = y * radial + d.p1 * (r2 + 2 * y * y) + 2 * d.p2 * x * y;
  return {c.fx * xd + c.cx, c.fy * yd + c.cy};
}

struct Moments {
  double area = 0;
  Vector2d centroid = Vector2d::Zero();
};

// Area and centroid of a disc's image: Green's theorem on an outline of very many points.
inline Moments disc_image(const roundel::CameraModel& camera, const roundel::Pose& pose,
                          double radius_m, int points = 20000) {
  const Eigen::Matrix3d rotation = pose.orientation.toRotationMatrix();
  const auto at = [&](int k) {
    const double angle = 2 * std::numbers::pi * k / points;
    return project(camera,
                   rotation * Vector3d(radius_m * std::cos(angle), radius_m * std::sin(angle), 0) +
                       pose.position);
  };
  const Vector2d origin = at(0);  // near by, so that no digits are lost
  double twice_area = 0;
  Vector2d sum(0, 0);
  Vector2d a(0, 0);
  for (int k = 1; k <= points; ++k) {
    const Vector2d b = at(k % points) - origin;
    const double cross = a.x() * b.y() - a.y() * b.x();
    twice_area += cross;
    sum += (a + b) * cross;
    a = b;
  }
  return {std::abs(twice_area) / 2, sum / (3 * twice_area) + origin};
}

// Weight of what is darker than `bright` in a picture: 1 for pixels of grey `dark`.
inline Moments darkness(const roundel::GreyImage& image, double dark, double bright) {
  Moments m;
  for (int v = 0; v < image.height; ++v) {
    for (int u = 0; u < image.width; ++u) {
      const double weight = (bright - image.view().at(u, v)) / (bright - dark);
      m.area += weight;
      m.centroid += weight * Vector2d(u, v);
    }
  }
  m.centroid /= m.area;
  return m;
}

// Variance of the darkness along u and v.
inline Vector2d spread(const roundel::GreyImage& image, double dark, double bright) {
  const Moments m = darkness(image, dark, bright);
  Vector2d sum(0, 0);
  for (int v = 0; v < image.height; ++v) {
    for (int u = 0; u < image.width; ++u) {
      const double weight = (bright - image.view().at(u, v)) / (bright - dark);
      sum += weight * (Vector2d(u, v) - m.centroid).cwiseAbs2();
    }
  }
  return sum / m.area;
}

// Whether the printed face is white at a point, from MARKERS.md sections 1 and 2; units of the
// black disc's radius.
inline bool white_at(const roundel::SceneMarker& marker, double x, double y) {
  const double rho = std::hypot(x, y);
  if (rho >= 1) return true;
  switch (marker.kind) {
    case roundel::MarkerKind::Disc:
      return false;
    case roundel::MarkerKind::WhyCon:
      return rho < marker.inner_ratio;
    case roundel::MarkerKind::WhyCode:
      break;
  }
  if (rho < 240.0 / 700) return true;
  if (rho >= 420.0 / 700) return false;
  double degrees = std::atan2(y, x) * 180 / std::numbers::pi;  // from 3 o'clock, counter-clockwise
  if (degrees < 0) degrees += 360;
  const double bit_width = 360.0 / marker.bits;
  const int bit = std::min(marker.bits - 1, static_cast<int>(degrees / bit_width));
  const bool first_half = degrees - bit * bit_width < bit_width / 2;
  const bool one = (marker.word >> (marker.bits - 1 - bit)) % 2 == 1;
  return one ? first_half : !first_half;
}

// Grey of one pixel, as the mean over `samples` x `samples` points of it.
inline double pixel_of(const roundel::SceneMarker& marker, const roundel::Imaging& imaging,
                       const roundel::CameraModel& camera, int u, int v, int samples) {
  const Eigen::Matrix3d rotation = marker.pose.orientation.toRotationMatrix();
  Vector2d rays[2][2];  // normalised, of the pixel's corners; between them the lens is linear
  for (int j = 0; j < 2; ++j) {
    for (int i = 0; i < 2; ++i) {
      rays[j][i] = *camera.normalise(Vector2d(u - 0.5 + i, v - 0.5 + j));
    }
  }
  const double radius = 0.5 * marker.diameter_m;
  double sum = 0;
  for (int j = 0; j < samples; ++j) {
    for (int i = 0; i < samples; ++i) {
      const double s = (i + 0.5) / samples, t = (j + 0.5) / samples;
      const Vector2d ray = (1 - t) * ((1 - s) * rays[0][0] + s * rays[0][1]) +
                           t * ((1 - s) * rays[1][0] + s * rays[1][1]);
      const Vector3d direction(ray.x(), ray.y(), 1);
      const Vector3d normal = rotation.col(2);
      const double depth = normal.dot(marker.pose.position) / normal.dot(direction);
      const Vector3d hit = direction * depth - marker.pose.position;
      const double x = rotation.col(0).dot(hit) / radius, y = rotation.col(1).dot(hit) / radius;
      if (std::hypot(x, y) >= marker.plate_ratio) {
        sum += imaging.floor;
      } else {
        sum += white_at(marker, x, y) ? imaging.white : imaging.black;
      }
    }
  }
  return sum / (samples * samples);
}

}  // namespace reference
