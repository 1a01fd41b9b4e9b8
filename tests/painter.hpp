#pragma once

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <optional>

#include "core/camera_model.hpp"
#include "core/grey_image.hpp"
#include "core/marker_geometry.hpp"
#include "core/pose.hpp"
#include "tests/random.hpp"

namespace roundel::test {

// What is printed: a necklace word, or a plain marker by its inner ratio.
struct Print {
  int bits = 8;
  std::uint32_t word = 0;
  double inner_ratio = 0;  // of a plain marker; 0: the word
  double diameter_m = kDefaultDiameter;
};

struct Paint {
  double black = 35, white = 215, floor = 120;
};

// A deliberately plain renderer for tests: every pixel is the mean of point samples, traced through
// the lens to the marker's plane. Slow, simple, and unlike the simulator's way of doing it.
class Painter {
 public:
  static constexpr int kSamples = 6;  // a pixel side

  Painter(const CameraModel& camera, const Paint& paint) : camera_(camera), paint_(paint) {
    image_.resize(camera.width, camera.height);
    std::fill(image_.pixels.begin(), image_.pixels.end(), round(paint.floor));
  }

  void add(const Print& print, const Pose& pose) {
    const double reach = kMarginRatio * print.diameter_m / 2;
    double u0 = 1e9, v0 = 1e9, u1 = -1e9, v1 = -1e9;
    for (int i = 0; i < 32; ++i) {
      const double t = i * std::numbers::pi / 16;
      const auto p = camera_.project(pose.to_camera({reach * std::cos(t), reach * std::sin(t), 0}));
      if (!p) continue;
      u0 = std::min(u0, p->x());
      u1 = std::max(u1, p->x());
      v0 = std::min(v0, p->y());
      v1 = std::max(v1, p->y());
    }
    const int last_u = std::min(image_.width - 1, static_cast<int>(u1) + 2);
    const int last_v = std::min(image_.height - 1, static_cast<int>(v1) + 2);
    for (int v = std::max(0, static_cast<int>(v0) - 2); v <= last_v; ++v) {
      for (int u = std::max(0, static_cast<int>(u0) - 2); u <= last_u; ++u)
        paint(print, pose, u, v);
    }
  }

  void add_noise(double sigma, std::uint64_t seed) {
    Random random(seed);
    for (std::uint8_t& pixel : image_.pixels) pixel = round(pixel + sigma * random.gaussian());
  }

  // Box blur, `passes` times three pixels wide in both directions (sigma = sqrt(passes * 2/3)).
  void blur(int passes) {
    for (int pass = 0; pass < passes; ++pass) {
      const GreyImage before = image_;
      for (int v = 1; v + 1 < image_.height; ++v) {
        for (int u = 1; u + 1 < image_.width; ++u) {
          int sum = 0;
          for (int dv = -1; dv <= 1; ++dv) {
            for (int du = -1; du <= 1; ++du) sum += before.view().at(u + du, v + dv);
          }
          image_.at(u, v) = static_cast<std::uint8_t>((sum + 4) / 9);
        }
      }
    }
  }

  GreyImage& image() { return image_; }
  LumaView view() const { return image_.view(); }

 private:
  static std::uint8_t round(double level) {
    return static_cast<std::uint8_t>(std::lround(std::fmin(255, std::fmax(0, level))));
  }

  // Grey level of a point of the marker's plane; nothing outside the white margin.
  std::optional<double> level(const Print& print, double x, double y) const {
    const double r = std::hypot(x, y) / (print.diameter_m / 2);
    if (r > kMarginRatio) return std::nullopt;
    if (r > 1) return paint_.white;
    if (print.inner_ratio > 0) return r < print.inner_ratio ? paint_.white : paint_.black;
    if (r > kCodeOuterRatio) return paint_.black;
    if (r < kCodeInnerRatio) return paint_.white;
    const double turn = std::atan2(y, x) / (2 * std::numbers::pi);
    const int half = static_cast<int>(std::floor((turn < 0 ? turn + 1 : turn) * 2 * print.bits)) %
                     (2 * print.bits);
    const bool bit = ((print.word >> (print.bits - 1 - half / 2)) & 1U) != 0;
    const bool white = bit == (half % 2 == 0);
    return white ? paint_.white : paint_.black;
  }

  void paint(const Print& print, const Pose& pose, int u, int v) {
    std::uint8_t& pixel = image_.at(u, v);
    const Eigen::Matrix3d to_marker = pose.orientation.toRotationMatrix().transpose();
    const Eigen::Vector3d eye = -(to_marker * pose.position);
    const auto middle = camera_.normalise(Eigen::Vector2d(u, v));
    if (!middle) return;
    // Within a pixel the lens is as good as linear.
    const Eigen::Matrix2d per_pixel = camera_.distort_jacobian(*middle).inverse() *
                                      Eigen::Vector2d(1 / camera_.fx, 1 / camera_.fy).asDiagonal();
    double sum = 0;
    for (int j = 0; j < kSamples; ++j) {
      for (int i = 0; i < kSamples; ++i) {
        const Eigen::Vector2d offset((i + 0.5) / kSamples - 0.5, (j + 0.5) / kSamples - 0.5);
        const Eigen::Vector2d ray = *middle + per_pixel * offset;
        const Eigen::Vector3d direction = to_marker * ray.homogeneous();
        const Eigen::Vector3d hit = eye - direction * (eye.z() / direction.z());
        const std::optional<double> here = level(print, hit.x(), hit.y());
        sum += here ? *here : pixel;
      }
    }
    pixel = round(sum / (kSamples * kSamples));
  }

  CameraModel camera_;
  Paint paint_;
  GreyImage image_;
};

}  // namespace roundel::test
