#include "simulator/figure.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "simulator/pattern.hpp"

namespace roundel {

namespace {

constexpr double kChordError = 0.004;     // pixels between a polygon's edge and its arc
constexpr double kInstantSpacing = 0.25;  // pixels between the places drawn of a moving figure
constexpr int kMaxInstants = 64;

[[noreturn]] void refuse(const std::string& what) {
  throw std::invalid_argument(what);
}

void require_size(double value, const char* name) {
  if (!(value > 0 && value < 1000)) {
    refuse(std::string(name) + " is " + std::to_string(value) + " m; it must be above 0");
  }
}

int corners_for(double radius_px) {
  const double step = std::sqrt(8 * kChordError / std::max(radius_px, 0.1));
  return std::clamp(static_cast<int>(std::ceil(2 * std::numbers::pi / step)), 24, 4096);
}

int pieces_for(double length_px) {
  return std::clamp(static_cast<int>(std::ceil(length_px / 8)), 1, 256);
}

}  // namespace

PixelRange PixelRange::intersection(const PixelRange& o) const {
  return {std::max(left, o.left), std::max(top, o.top), std::min(right, o.right),
          std::min(bottom, o.bottom)};
}

PixelRange PixelRange::hull(const PixelRange& o) const {
  if (empty()) return o;
  if (o.empty()) return *this;
  return {std::min(left, o.left), std::min(top, o.top), std::max(right, o.right),
          std::max(bottom, o.bottom)};
}

Figure::Figure(const SceneMarker& marker, const Imaging& imaging, const Response& response,
               const CameraModel& camera) {
  require_size(marker.diameter_m, "diameter_m");
  if (!(marker.plate_ratio >= 1 && marker.plate_ratio < 100)) {
    refuse("plate_ratio is " + std::to_string(marker.plate_ratio) + "; it must be at least 1");
  }
  const auto white = static_cast<float>(response.light_of_grey(imaging.white));
  const auto step = static_cast<float>(response.light_of_grey(imaging.black)) - white;
  const double plate = marker.diameter_m * marker.plate_ratio;
  base_ = {Outline::Ellipse, 0, 0, plate, plate, white};
  print_[0] = {Outline::Ellipse, 0, 0, marker.diameter_m, marker.diameter_m, step};
  print_count_ = 1;
  if (marker.kind == MarkerKind::WhyCon) {
    if (!(marker.inner_ratio > 0 && marker.inner_ratio < 1)) {
      refuse("inner_ratio is " + std::to_string(marker.inner_ratio) +
             "; it must lie between 0 and 1");
    }
    const double inner = marker.diameter_m * marker.inner_ratio;
    print_[1] = {Outline::Ellipse, 0, 0, inner, inner, -step};
    print_count_ = 2;
  } else if (marker.kind == MarkerKind::WhyCode) {
    if (marker.bits < kMinBits || marker.bits > kMaxBits || marker.word >> marker.bits != 0) {
      refuse("word " + std::to_string(marker.word) + " of " + std::to_string(marker.bits) +
             " bits cannot be drawn; bits lie between 2 and 16");
    }
    bits_ = marker.bits;
    word_ = marker.word;
    code_radius_ = 0.5 * marker.diameter_m;
    code_light_ = -step;
  }
  place(marker.pose, marker.velocity, marker.spin, imaging.exposure_s, camera);
  if (facing_ < 0) visible_ = false;
}

Figure::Figure(const SceneShape& shape, const Imaging& imaging, const Response& response,
               const CameraModel& camera) {
  require_size(shape.width_m, "width_m");
  require_size(shape.height_m, "height_m");
  if (!(shape.hole_ratio >= 0 && shape.hole_ratio < 1)) {
    refuse("hole_ratio is " + std::to_string(shape.hole_ratio) + "; it must lie in [0, 1)");
  }
  const auto light = static_cast<float>(response.light_of_grey(shape.grey));
  base_ = {shape.outline, 0, 0, shape.width_m, shape.height_m, light};
  if (shape.hole_ratio > 0) {
    const auto hole = static_cast<float>(response.light_of_grey(shape.hole_grey));
    print_[0] = {shape.hole,
                 shape.hole_offset_m.x(),
                 shape.hole_offset_m.y(),
                 shape.width_m * shape.hole_ratio,
                 shape.height_m * shape.hole_ratio,
                 hole - light};
    print_count_ = 1;
  }
  place(shape.pose, shape.velocity, shape.spin, imaging.exposure_s, camera);
}

void Figure::place(const Pose& pose, const Eigen::Vector3d& velocity, const Eigen::Vector3d& spin,
                   double exposure_s, const CameraModel& camera) {
  pose_ = pose;
  velocity_ = velocity;
  spin_ = spin;
  exposure_s_ = exposure_s;
  facing_ = pose.normal().dot(pose.position) < 0 ? 1 : -1;
  visible_ = measure(camera);
}

Figure::Instant Figure::at(double time_s) const {
  const Eigen::Vector3d turn = spin_ * time_s;
  const double angle = turn.norm();
  Eigen::Quaterniond orientation = pose_.orientation;
  if (angle > 0) {
    orientation = Eigen::Quaterniond(Eigen::AngleAxisd(angle, turn / angle)) * orientation;
  }
  return {pose_.position + velocity_ * time_s, orientation * Eigen::Vector3d::UnitX(),
          orientation * Eigen::Vector3d::UnitY()};
}

// The pixels touched, and how many instants the exposure needs. False if not all of it projects.
bool Figure::measure(const CameraModel& camera) {
  constexpr int kSides = 32;  // points on the base's outline
  const Instant first = at(-0.5 * exposure_s_), last = at(0.5 * exposure_s_);
  const double reach = 0.5 * std::hypot(base_.width, base_.height);
  const double nearest = std::min(first.origin.z(), last.origin.z()) - reach;
  if (!(nearest > 0)) return false;
  pixels_per_m_ = std::max(camera.fx, camera.fy) / nearest;

  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Eigen::Vector2d low(kInfinity, kInfinity), high = -low;
  double travel = 0;
  bool seen = true;
  const auto take = [&](const Eigen::Vector2d& p) {
    Eigen::Vector2d before(0, 0);
    for (const Instant* instant : {&first, &last}) {
      const auto pixel =
          camera.project(instant->origin + p.x() * instant->x_axis + p.y() * instant->y_axis);
      if (!pixel) {
        seen = false;
        return;
      }
      low = low.cwiseMin(*pixel);
      high = high.cwiseMax(*pixel);
      if (instant == &last) travel = std::max(travel, (*pixel - before).norm());
      before = *pixel;
    }
  };
  if (base_.outline == Outline::Ellipse) {
    // A polygon around the ellipse, not in it.
    const double around = 1 / std::cos(std::numbers::pi / kSides);
    emit_ellipse({0, 0}, 0.5 * base_.width * around, 0.5 * base_.height * around, kSides, take);
  } else {
    emit_rectangle({0, 0}, base_.width, base_.height, kSides / 4, take);
  }
  // Far outside nothing is drawn, and integers could overflow.
  if (!seen || low.minCoeff() < -1e6 || high.maxCoeff() > 1e6) return false;
  box_ = {static_cast<int>(std::floor(low.x())) - 1, static_cast<int>(std::floor(low.y())) - 1,
          static_cast<int>(std::ceil(high.x())) + 2, static_cast<int>(std::ceil(high.y())) + 2};
  instants_ = std::clamp(static_cast<int>(std::ceil(travel / kInstantSpacing)), 1, kMaxInstants);
  return true;
}

// Where a point of the figure's plane lies on the drawing grid. measure() has made sure that it
// projects.
Eigen::Vector2d Figure::on_grid(const Eigen::Vector2d& p, const Instant& instant,
                                const CameraModel& camera, const FineFrame& frame) {
  const Eigen::Vector3d x = instant.origin + p.x() * instant.x_axis + p.y() * instant.y_axis;
  const Eigen::Vector2d pixel = camera.to_pixel(camera.distort(x.head<2>() / x.z()));
  return {(pixel.x() - frame.left + 0.5) * frame.factor,
          (pixel.y() - frame.top + 0.5) * frame.factor};
}

void Figure::draw(const CameraModel& camera, const FineFrame& frame, CoverageGrid& base,
                  CoverageGrid& print) const {
  // Outlines run counter-clockwise on the face, which subtracts: see CoverageGrid.
  const double share = -facing_ / instants_;
  for (int k = 0; k < instants_; ++k) {
    const Instant instant = at(exposure_s_ * ((k + 0.5) / instants_ - 0.5));
    draw_layer(base_, instant, camera, frame, share, base);
    for (int layer = 0; layer < print_count_; ++layer) {
      const Layer& printed = print_[static_cast<std::size_t>(layer)];
      draw_layer(printed, instant, camera, frame, share * static_cast<double>(printed.light),
                 print);
    }
    if (bits_ == 0) continue;
    const double outer_px = code_radius_ * kCodeOuterRatio * pixels_per_m_;
    const int per_half = (corners_for(outer_px) + 2 * bits_ - 1) / (2 * bits_);
    print.begin(share * static_cast<double>(code_light_));
    emit_code(word_, bits_, std::max(per_half, 2), pieces_for(0.5 * outer_px), code_radius_,
              [&](const Eigen::Vector2d& p) { print.add(on_grid(p, instant, camera, frame)); });
    print.end();
  }
}

void Figure::draw_layer(const Layer& layer, const Instant& instant, const CameraModel& camera,
                        const FineFrame& frame, double weight, CoverageGrid& grid) const {
  const auto take = [&](const Eigen::Vector2d& p) { grid.add(on_grid(p, instant, camera, frame)); };
  const Eigen::Vector2d centre(layer.centre_x, layer.centre_y);
  const double larger_px = std::max(layer.width, layer.height) * pixels_per_m_;
  grid.begin(weight);
  if (layer.outline == Outline::Ellipse) {
    emit_ellipse(centre, 0.5 * layer.width, 0.5 * layer.height, corners_for(0.5 * larger_px), take);
  } else {
    emit_rectangle(centre, layer.width, layer.height, pieces_for(larger_px), take);
  }
  grid.end();
}

bool Figure::operator==(const Figure& o) const {
  return visible_ == o.visible_ && base_ == o.base_ && print_ == o.print_ &&
         print_count_ == o.print_count_ && bits_ == o.bits_ && word_ == o.word_ &&
         code_radius_ == o.code_radius_ && code_light_ == o.code_light_ &&
         pose_.position == o.pose_.position &&
         pose_.orientation.coeffs() == o.pose_.orientation.coeffs() && velocity_ == o.velocity_ &&
         spin_ == o.spin_;
}

}  // namespace roundel
