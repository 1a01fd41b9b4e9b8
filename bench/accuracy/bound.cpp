#include "bench/accuracy/bound.hpp"

#include <Eigen/Dense>
#include <algorithm>

#include "bench/common/composer.hpp"

namespace roundel::bench {

namespace {

constexpr double kRounding = 1.0 / 12;   // variance of rounding to whole grey levels
constexpr double kStepPx = 0.05;         // of the outline, for derivatives
constexpr double kMaxTiltStep = 0.005;   // radians
constexpr double kBlurStep = 0.02;       // pixels
constexpr double kLeastChange = 0.1;     // of the whole picture, grey levels, by one step
constexpr double kMinCondition = 1e-10;  // of the information: less is nothing but rounding

class Differentiator {
 public:
  Differentiator(const Experiment& experiment, const Print& print, const PlacedMarker& marker)
      : experiment_(experiment), imaging_(experiment.imaging), print_(print), marker_(marker) {
    // No edge between plate and floor: nobody tells a tracker how large the plate is.
    imaging_.floor = imaging_.white;
    const Composer composer(experiment.camera, imaging_, {});
    const PixelRange image{0, 0, experiment.camera.width, experiment.camera.height};
    box_ = print(imaging_, composer.response(), marker)
               .box.grown(composer.margin() + 2)
               .intersection(image);
  }

  bool empty() const { return box_.empty(); }

  // Half the difference of two pictures over the step.
  Eigen::VectorXd by_pose(const Pose& plus, const Pose& minus, double step) const {
    return (picture(imaging_, plus) - picture(imaging_, minus)) / (2 * step);
  }
  Eigen::VectorXd by_imaging(double Imaging::*parameter, double step) const {
    Imaging plus = imaging_, minus = imaging_;
    plus.*parameter += step;
    minus.*parameter -= step;
    plus.floor = plus.white;
    minus.floor = minus.white;
    return (picture(plus, marker_.pose) - picture(minus, marker_.pose)) / (2 * step);
  }

 private:
  Eigen::VectorXd picture(const Imaging& imaging, const Pose& pose) const {
    Composer composer(experiment_.camera, imaging, {});
    PlacedMarker moved = marker_;
    moved.pose = pose;
    const Drawing drawing = print_(imaging, composer.response(), moved);
    const std::vector<float>& light = composer.compose(box_, {&drawing, 1});
    Eigen::VectorXd grey(static_cast<Eigen::Index>(light.size()));
    for (std::size_t i = 0; i < light.size(); ++i) {
      grey[static_cast<Eigen::Index>(i)] =
          composer.response().grey_of_light(static_cast<double>(light[i]));
    }
    return grey;
  }

  const Experiment& experiment_;
  Imaging imaging_;
  const Print& print_;
  const PlacedMarker& marker_;
  PixelRange box_;
};

// Two directions across the line of sight and, last, along it. Depth must not be taken along the
// camera's axis: off the axis that moves the picture sideways by pixels for a step that changes its
// size by hundredths, and the derivative would be none.
Eigen::Matrix3d axes_of_sight(const Eigen::Vector3d& position) {
  return Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), position).toRotationMatrix();
}

Pose moved(Pose pose, const Eigen::Matrix3d& axes, int axis, double step) {
  if (axis < 3) {
    pose.position += step * axes.col(axis);
  } else {
    pose.orientation = pose.orientation * Eigen::AngleAxisd(step, Eigen::Vector3d::Unit(axis - 3));
  }
  return pose;
}

}  // namespace

std::optional<PoseCovariance> cramer_rao_bound(const Experiment& experiment, const Print& print,
                                               const PlacedMarker& marker, bool has_yaw) {
  const Differentiator picture(experiment, print, marker);
  if (picture.empty()) return std::nullopt;
  const double distance = marker.pose.position.norm();
  const double pixel_m = distance / experiment.camera.fx;
  const double radius_px = 0.5 * experiment.diameter_m / pixel_m;

  std::vector<Eigen::VectorXd> columns;
  const int axes = has_yaw ? 6 : 5;
  const Eigen::Matrix3d sight = axes_of_sight(marker.pose.position);
  const double tilt_step = std::min(kMaxTiltStep, 2 * kStepPx / radius_px);
  const double steps[6] = {kStepPx * pixel_m, kStepPx * pixel_m, kStepPx * distance / radius_px,
                           tilt_step,         tilt_step,         kStepPx / radius_px};
  for (int axis = 0; axis < axes; ++axis) {
    columns.push_back(picture.by_pose(moved(marker.pose, sight, axis, steps[axis]),
                                      moved(marker.pose, sight, axis, -steps[axis]), steps[axis]));
    // A plain ring looks the same whichever way it is turned; what is left is rounding.
    if (columns.back().norm() * steps[axis] < kLeastChange) return std::nullopt;
  }
  columns.push_back(picture.by_imaging(&Imaging::black, 1));
  columns.push_back(picture.by_imaging(&Imaging::white, 1));
  if (experiment.imaging.blur_px > kBlurStep) {
    columns.push_back(picture.by_imaging(&Imaging::blur_px, kBlurStep));
  }

  const auto count = std::ssize(columns);
  Eigen::MatrixXd information(count, count);
  const double sigma = experiment.imaging.noise_sigma;
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    for (std::ptrdiff_t j = 0; j < count; ++j) {
      information(i, j) =
          columns[static_cast<std::size_t>(i)].dot(columns[static_cast<std::size_t>(j)]) /
          (sigma * sigma + kRounding);
    }
  }
  // Scaled to a diagonal of ones, because metres and grey levels differ by orders of magnitude.
  const Eigen::VectorXd scale = information.diagonal().cwiseSqrt().cwiseInverse();
  if (!scale.allFinite()) return std::nullopt;
  const Eigen::LDLT<Eigen::MatrixXd> solver(scale.asDiagonal() * information * scale.asDiagonal());
  if (!solver.isPositive() || solver.rcond() < kMinCondition) return std::nullopt;
  const Eigen::MatrixXd covariance = scale.asDiagonal() *
                                     solver.solve(Eigen::MatrixXd::Identity(count, count)) *
                                     scale.asDiagonal();
  if (!covariance.allFinite()) return std::nullopt;
  PoseCovariance result = PoseCovariance::Zero();
  result.topLeftCorner(axes, axes) = covariance.topLeftCorner(axes, axes);
  PoseCovariance to_camera = PoseCovariance::Identity();
  to_camera.topLeftCorner<3, 3>() = sight;
  return to_camera * result * to_camera.transpose();
}

}  // namespace roundel::bench
