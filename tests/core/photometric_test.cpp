#include <doctest/doctest.h>

#include <Eigen/Cholesky>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/lens_patch.hpp"
#include "core/necklace.hpp"
#include "core/photometric_fit.hpp"
#include "core/photometric_kernel.hpp"
#include "core/plane_projection.hpp"
#include "tests/painter.hpp"

using namespace roundel;  // NOLINT(google-build-using-namespace)
using roundel::test::Painter;
using roundel::test::Random;

namespace {

CameraModel small_camera() {
  CameraModel camera;
  camera.width = 200;
  camera.height = 160;
  camera.fx = 700;
  camera.fy = 702;
  camera.cx = 60;
  camera.cy = 101;
  camera.distortion = {-0.28, 0.09, 0.0006, -0.0009, -0.012};
  return camera;
}

Pose tilted(double tilt, double direction, double yaw, double z) {
  const Eigen::Vector3d centre(0.05 * z, -0.03 * z, z);
  const Eigen::Vector3d ray = -centre.normalized();
  const Eigen::Vector3d axis = Eigen::AngleAxisd(direction, ray) * ray.unitOrthogonal();
  return pose_from_circle({centre, Eigen::AngleAxisd(tilt, axis) * ray}, yaw);
}

// The outline that a moment ellipse would give, good to a pixel or so.
Ellipse rough_ellipse(const CameraModel& camera, const Pose& pose, double radius) {
  const Eigen::Vector2d centre = *camera.project(pose.position);
  double a = 0, b = 1e9, angle = 0;
  for (int i = 0; i < 64; ++i) {
    const double t = i * std::numbers::pi / 32;
    const Eigen::Vector2d arm =
        *camera.project(pose.to_camera({radius * std::cos(t), radius * std::sin(t), 0})) - centre;
    if (arm.norm() > a) {
      a = arm.norm();
      angle = std::atan2(arm.y(), arm.x());
    }
    b = std::min(b, arm.norm());
  }
  return {centre.x(), centre.y(), a, b, angle};
}

Pose disturbed(const Pose& pose, Random& random) {
  Pose start = pose;
  const double z = pose.position.z();
  start.position += Eigen::Vector3d(random.gaussian() * 2e-4, random.gaussian() * 2e-4,
                                    random.gaussian() * 3e-3) *
                    z;
  const Eigen::Vector3d turn(random.gaussian(), random.gaussian(), random.gaussian());
  start.orientation = Eigen::Quaterniond(Eigen::AngleAxisd(0.02 * turn.norm(), turn.normalized())) *
                      pose.orientation;
  return start;
}

constexpr double kRadius = kDefaultDiameter / 2;

Pattern code_pattern(int id) {
  return {Pattern::Kind::kCode, 8, *NecklaceCode(8, 1).word(id), 0};
}

std::optional<PhotometricPose> fit_code(PhotometricFit& fit, const Pose& start, int id,
                                        int max_steps) {
  const Pattern pattern = code_pattern(id);
  FitPlan plan;
  plan.deviation = 27;
  plan.max_steps = max_steps;
  return fit.fit(fit.first_guess(start, {35, 215}, pattern, {}), pattern, {}, plan);
}

}  // namespace

TEST_CASE("within a marker the lens patch is as good as the exact inverse of the lens") {
  const CameraModel camera = small_camera();
  const Eigen::Vector2d middle(140, 40);
  const auto patch = LensPatch::make(camera, middle, 60);
  REQUIRE(patch.has_value());
  for (int dv = -40; dv <= 40; dv += 8) {
    for (int du = -40; du <= 40; du += 8) {
      const Eigen::Vector2d exact = *camera.normalise(middle + Eigen::Vector2d(du, dv));
      CHECK((patch->normalise(du, dv) - exact).norm() * camera.fx < 3e-3);
    }
  }
}

TEST_CASE("many pixels at once get the patch's points, the same by any vector unit") {
  const auto patch = LensPatch::make(small_camera(), {140, 40}, 60);
  REQUIRE(patch.has_value());
  std::vector<float> du, dv;
  for (int i = 0; i < 64; ++i) {
    du.push_back(static_cast<float>(i % 8 * 10 - 35));
    dv.push_back(static_cast<float>(i / 8 * 10 - 35));
  }
  std::vector<float> x = du, y = dv, other_x = du, other_y = dv;
  remove_lens(patch->cubic(), x.data(), y.data(), 64);
  remove_lens(patch->cubic(), other_x.data(), other_y.data(), 64, VectorUnit::kBaseline);
  CHECK(x == other_x);
  CHECK(y == other_y);
  for (std::size_t i = 0; i < 64; ++i) {
    const Eigen::Vector2d expected = patch->normalise(du[i], dv[i]) - patch->normalise(0, 0);
    CHECK(std::abs(x[i] - expected.x()) < 1e-7);
    CHECK(std::abs(y[i] - expected.y()) < 1e-7);
  }
}

TEST_CASE("from a disturbed start the fit comes back to the painted pose") {
  const CameraModel camera = small_camera();
  Random random(31);
  PhotometricFit fit{ResponseCurve::linear()};
  for (int i = 0; i < 40; ++i) {
    CAPTURE(i);
    const Pose truth = tilted(random.uniform(0.15, 1.2), random.uniform(0, 6),
                              random.uniform(-3, 3), random.uniform(1.0, 2.2));
    const int id = random.integer(1, 30);
    Painter painter(camera, {});
    painter.add({8, *NecklaceCode(8, 1).word(id)}, truth);
    REQUIRE(fit.load(painter.view(), camera, rough_ellipse(camera, truth, kRadius), kRadius, 3));
    const auto found = fit_code(fit, disturbed(truth, random), id, 10);
    REQUIRE(found.has_value());
    // Sharp edges: what is left is the rounding of the grey levels and the painter's point samples.
    CHECK((found->state.pose.position - truth.position).norm() / truth.position.z() < 1.5e-3);
    CHECK(orientation_error(found->state.pose.orientation, truth.orientation) < 4e-3);
    CHECK(found->state.dark == doctest::Approx(35).epsilon(0.03));
    CHECK(found->state.contrast == doctest::Approx(180).epsilon(0.01));
  }
}

TEST_CASE("glare on a part of the marker moves the pose little") {
  const CameraModel camera = small_camera();
  const Pose truth = tilted(0.5, 1, 0.7, 1.2);
  Painter painter(camera, {});
  painter.add({8, *NecklaceCode(8, 1).word(9)}, truth);
  painter.blur(1);
  const Ellipse ellipse = rough_ellipse(camera, truth, kRadius);
  GreyImage& image = painter.image();
  for (int v = 0; v < image.height; ++v) {
    for (int u = 0; u < image.width; ++u) {
      if (std::hypot(u - ellipse.u - 0.9 * ellipse.a, v - ellipse.v) < 0.25 * ellipse.a) {
        image.at(u, v) = 255;
      }
    }
  }
  PhotometricFit fit{ResponseCurve::linear()};
  REQUIRE(fit.load(painter.view(), camera, ellipse, kRadius, 3));
  Random random(32);
  const auto found = fit_code(fit, disturbed(truth, random), 9, 12);
  REQUIRE(found.has_value());
  CHECK((found->state.pose.position - truth.position).norm() < 0.01);
  CHECK(orientation_error(found->state.pose.orientation, truth.orientation) < 0.02);
}

TEST_CASE("the stated covariance is that of the errors over many noisy pictures") {
  const CameraModel camera = small_camera();
  Random random(33);
  PhotometricFit fit{ResponseCurve::linear()};
  double squares = 0;
  constexpr int kPictures = 120;
  for (int i = 0; i < kPictures; ++i) {
    const Pose truth = tilted(random.uniform(0.3, 0.9), random.uniform(0, 6), random.uniform(-3, 3),
                              random.uniform(1.2, 1.8));
    Painter painter(camera, {});
    painter.add({8, *NecklaceCode(8, 1).word(4)}, truth);
    painter.blur(1);
    painter.add_noise(5, static_cast<std::uint64_t>(100 + i));
    REQUIRE(fit.load(painter.view(), camera, rough_ellipse(camera, truth, kRadius), kRadius, 3));
    const auto found = fit_code(fit, disturbed(truth, random), 4, 8);
    REQUIRE(found.has_value());
    const Eigen::AngleAxisd turn(truth.orientation * found->state.pose.orientation.conjugate());
    const double angle = std::remainder(turn.angle(), 2 * std::numbers::pi);
    Eigen::Matrix<double, 6, 1> error;
    error << truth.position - found->state.pose.position, angle * turn.axis();
    squares += error.dot(found->covariance.ldlt().solve(error));
  }
  // Six degrees of freedom; the deviation of the mean over so many pictures is 5 %.
  CHECK(squares / kPictures / 6 == doctest::Approx(1).epsilon(0.3));
}

namespace {

// A model and pixels as the fit would make them, for tests of the kernel alone.
struct KernelCase {
  PhotometricModel model{};
  std::vector<float> x, y, grey, weight;
  PixelColumns columns() const {
    return {x.data(), y.data(), grey.data(), weight.data(), static_cast<int>(x.size())};
  }
};

// d(normalised)/d(pixel), row by row.
constexpr std::array<float, 4> kSlope = {1.0F / 800, 0.00002F, -0.00001F, 1.0F / 810};

KernelCase kernel_case(int halves, double low, double high) {
  KernelCase c;
  // A plane one unit of depth away, tilted a little: w = H^-1 n.
  c.model.at = {0.02F, -0.01F, 1.0F};
  c.model.by_x = {40.0F, 3.0F, 0.15F};
  c.model.by_y = {-2.0F, 38.0F, -0.1F};
  for (std::size_t k = 0; k < 3; ++k) {  // a pixel is about 1/800
    c.model.by_u[k] = c.model.by_x[k] * kSlope[0] + c.model.by_y[k] * kSlope[2];
    c.model.by_v[k] = c.model.by_x[k] * kSlope[1] + c.model.by_y[k] * kSlope[3];
  }
  c.model.eye = {0.5F, -0.3F, 40.0F};
  c.model.dark = 30;
  c.model.contrast = 170;
  c.model.slope_x = 0.05F;
  c.model.slope_y = -0.03F;
  c.model.blur = 0.85F;
  c.model.shift = 0.1F;
  c.model.stretch_u = 0.2F;
  c.model.stretch_d = -0.1F;
  c.model.inner = halves > 0 ? static_cast<float>(kCodeInnerRatio) : 0.45F;
  c.model.halves = halves;
  const auto bright = [](int k) { return (k * k / 3) % 2 != 0 ? 1U : 0U; };
  for (int neighbour = 0; neighbour < 5; ++neighbour) {
    std::uint32_t word = 0;
    for (int k = 0; k < halves; ++k) word |= bright((k + neighbour - 2 + halves) % halves) << k;
    c.model.colours[static_cast<std::size_t>(neighbour)] = static_cast<std::int32_t>(word);
  }
  c.model.robust_scale = c.model.outlier = 1e9F;
  Random random(34);
  while (c.x.size() < 13 * kPixelBlock) {
    const double radius = random.uniform(low, high), angle = random.uniform(0, 6.28);
    c.x.push_back(static_cast<float>(radius * std::cos(angle) / 40));
    c.y.push_back(static_cast<float>(radius * std::sin(angle) / 38));
    c.grey.push_back(static_cast<float>(random.uniform(30, 200)));
    c.weight.push_back(1);
  }
  return c;
}

using AddPixels = void (*)(const PhotometricModel&, const PixelColumns&, int, PhotometricSums&,
                           VectorUnit);

// Right side of the normal equations per unknown by finite differences of the squared residuals.
void check_derivatives(KernelCase c, AddPixels add_pixels) {
  PhotometricSums sums;
  add_pixels(c.model, c.columns(), kPhotometricUnknowns, sums, VectorUnit::kBest);
  const auto squares_with = [&](float PhotometricModel::*member, double step, bool logarithm) {
    PhotometricModel m = c.model;
    m.*member = static_cast<float>(logarithm ? (m.*member) * std::exp(step) : (m.*member) + step);
    PhotometricSums s;
    add_pixels(m, c.columns(), kPhotometricUnknowns, s, VectorUnit::kBest);
    return static_cast<double>(s.squares);
  };
  struct Case {
    int unknown;
    float PhotometricModel::*member;
    double step;
    bool logarithm = false;
    double tolerance = 0.03;
  };
  for (const Case& t : {Case{kDark, &PhotometricModel::dark, 0.5},
                        Case{kContrast, &PhotometricModel::contrast, 0.5},
                        Case{kSlopeX, &PhotometricModel::slope_x, 0.01},
                        Case{kSlopeY, &PhotometricModel::slope_y, 0.01},
                        Case{kShift, &PhotometricModel::shift, 0.02},
                        // What a stretch does to the edges' profiles at corners is left out.
                        Case{kStretchU, &PhotometricModel::stretch_u, 0.02, false, 0.06},
                        Case{kStretchD, &PhotometricModel::stretch_d, 0.02, false, 0.06},
                        Case{kBlur, &PhotometricModel::blur, 0.02, true}}) {
    CAPTURE(t.unknown);
    const double slope = (squares_with(t.member, t.step, t.logarithm) -
                          squares_with(t.member, -t.step, t.logarithm)) /
                         (2 * t.step);
    const double expected = -2.0 * sums.right_side[static_cast<std::size_t>(t.unknown)];
    CHECK(slope == doctest::Approx(expected).epsilon(t.tolerance));
  }
}

}  // namespace

TEST_CASE("the kernel's derivatives agree with finite differences") {
  check_derivatives(kernel_case(16, 0.85, 1.15), add_outer_pixels);
  check_derivatives(kernel_case(16, 0.2, 0.75), add_inner_pixels);
  check_derivatives(kernel_case(0, 0.3, 0.6), add_inner_pixels);
}

namespace {

// As sharp as a pixel lets a picture be.
KernelCase boxed_case(int halves, double low, double high) {
  KernelCase c = kernel_case(halves, low, high);
  c.model.boxed = true;
  c.model.blur = 0.4F;
  c.model.stretch_u = c.model.stretch_d = 0;
  return c;
}

}  // namespace

TEST_CASE("the derivatives of boxed edges agree with finite differences") {
  check_derivatives(boxed_case(16, 0.9, 1.1), add_outer_pixels);
  check_derivatives(boxed_case(16, 0.2, 0.75), add_inner_pixels);
  check_derivatives(boxed_case(0, 0.3, 0.6), add_inner_pixels);
}

TEST_CASE("a boxed edge looks as the area that it covers of the pixels") {
  KernelCase c = boxed_case(16, 0.97, 1.03);
  c.model.blur = 0.2887F;  // nothing but the pixel
  c.model.dark = 0;
  c.model.contrast = 1;
  c.model.shift = c.model.slope_x = c.model.slope_y = 0;
  const auto radius = [&](double nx, double ny) {
    std::array<double, 3> p{};
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = static_cast<double>(c.model.at[k]) + static_cast<double>(c.model.by_x[k]) * nx +
             static_cast<double>(c.model.by_y[k]) * ny;
    }
    return std::hypot(p[0], p[1]) / p[2];
  };
  const auto& slope = kSlope;
  for (std::size_t i = 0; i < c.x.size(); ++i) {
    constexpr int kParts = 24;
    int outside = 0;
    for (int a = 0; a < kParts; ++a) {
      for (int b = 0; b < kParts; ++b) {
        const double du = (a + 0.5) / kParts - 0.5, dv = (b + 0.5) / kParts - 0.5;
        const double nx = c.x[i] + slope[0] * du + slope[1] * dv;
        const double ny = c.y[i] + slope[2] * du + slope[3] * dv;
        if (radius(nx, ny) > 1) ++outside;
      }
    }
    c.grey[i] = static_cast<float>(outside) / (kParts * kParts);
  }
  const auto rms = [&](bool boxed) {
    c.model.boxed = boxed;
    PhotometricSums sums;
    add_outer_pixels(c.model, c.columns(), kCodeUnknowns, sums);
    return std::sqrt(static_cast<double>(sums.squares) / static_cast<double>(c.x.size()));
  };
  CHECK(rms(true) < 0.005);
  CHECK(rms(false) > 0.02);
}

TEST_CASE("vector units give the same sums to the bit") {
  for (const int unknowns : {int(kFollowedUnknowns), int(kCodeUnknowns)}) {
    for (int kind = 0; kind < 4; ++kind) {
      const bool inner = kind % 2 == 1;
      KernelCase c = kernel_case(16, inner ? 0.2 : 0.85, inner ? 0.75 : 1.15);
      c.model.boxed = kind >= 2;
      PhotometricSums best, next, baseline;
      const AddPixels add = inner ? add_inner_pixels : add_outer_pixels;
      add(c.model, c.columns(), unknowns, best, VectorUnit::kBest);
      add(c.model, c.columns(), unknowns, next, VectorUnit::kNextBest);
      add(c.model, c.columns(), unknowns, baseline, VectorUnit::kBaseline);
      CHECK(best.normal_matrix == next.normal_matrix);
      CHECK(best.right_side == next.right_side);
      CHECK(best.squares == baseline.squares);
      CHECK(best.normal_matrix == baseline.normal_matrix);
      CHECK(best.right_side == baseline.right_side);
    }
  }
}

TEST_CASE("pulls are the right side of the same equations, on every vector unit") {
  for (int kind = 0; kind < 6; ++kind) {
    const bool inner = kind % 3 != 0, plain = kind % 3 == 2;
    KernelCase c = kernel_case(plain ? 0 : 16, inner ? 0.2 : 0.85, inner ? 0.75 : 1.15);
    c.model.boxed = kind >= 3;
    PhotometricSums all;
    const int unknowns = plain ? kPhotometricUnknowns : kCodeUnknowns;
    (inner ? add_inner_pixels : add_outer_pixels)(c.model, c.columns(), unknowns, all,
                                                  VectorUnit::kBest);
    for (const VectorUnit unit :
         {VectorUnit::kBest, VectorUnit::kNextBest, VectorUnit::kBaseline}) {
      PhotometricSums pulls;
      (inner ? add_inner_pulls : add_outer_pulls)(c.model, c.columns(), pulls, unit);
      CHECK(pulls.squares == all.squares);
      CHECK(pulls.weights == all.weights);
      CHECK(pulls.right_side == all.right_side);
      CHECK(pulls.normal_matrix == PhotometricSums{}.normal_matrix);
    }
  }
}

TEST_CASE("fewer unknowns are the first part of the same equations") {
  const KernelCase c = kernel_case(16, 0.2, 0.75);
  PhotometricSums all, few;
  add_inner_pixels(c.model, c.columns(), kCodeUnknowns, all);
  add_inner_pixels(c.model, c.columns(), kFollowedUnknowns, few);
  CHECK(few.squares == all.squares);
  for (std::size_t i = 0; i < kFollowedUnknowns; ++i) CHECK(few.right_side[i] == all.right_side[i]);
  CHECK(few.right_side[kSlopeX] == 0);
}
