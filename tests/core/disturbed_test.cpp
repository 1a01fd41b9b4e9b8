#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "core/necklace.hpp"
#include "core/tracker.hpp"
#include "tests/painter.hpp"

using namespace roundel;  // NOLINT(google-build-using-namespace)
using roundel::test::Painter;

namespace {

constexpr int kId = 17;
constexpr double kDiameter = 0.08;  // metres, of 32 pixels

// A marker that drives slowly across the picture, and what happens to it there.
class Film {
 public:
  Film() {
    camera_.width = 320;
    camera_.height = 240;
    camera_.fx = camera_.fy = 400;
    camera_.cx = 160;
    camera_.cy = 120;
    DetectorParameters parameters;
    parameters.diameter_m = kDiameter;
    tracker_.emplace(parameters, camera_);
  }

  // `disturb(grey, x, y)`: what becomes of a grey level at (x, y), in radii from the marker's
  // middle.
  template <typename Disturb>
  std::span<const Marker> show(const Disturb& disturb, int id = kId) {
    const Eigen::Quaterniond facing(Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX()));
    const Eigen::Quaterniond tilt(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitY()));
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.4 + 0.01 * frame_, Eigen::Vector3d::UnitZ()));
    truth = {{-0.05 + 0.002 * frame_, 0.01, 1.0}, with_positive_w(tilt * facing * turn)};
    Painter painter(camera_, {});
    painter.add({8, *NecklaceCode(8, 1).word(id), 0, kDiameter}, truth);
    painter.blur(1);
    const Eigen::Vector2d middle = camera_.project(truth.position).value();
    const double radius = camera_.fx * kDiameter / 2 / truth.position.z();
    GreyImage& image = painter.image();
    for (int v = 0; v < image.height; ++v) {
      for (int u = 0; u < image.width; ++u) {
        auto& pixel = image.at(u, v);
        const double level = disturb(pixel, (u - middle.x()) / radius, (v - middle.y()) / radius);
        pixel = static_cast<std::uint8_t>(std::lround(std::min(255.0, level)));
      }
    }
    painter.add_noise(2, static_cast<std::uint64_t>(++frame_));
    return tracker_->track(painter.view());
  }
  void warm_up() {
    for (int i = 0; i < 12; ++i) {
      show([](double grey, double, double) { return grey; });
    }
  }

  Pose truth;

 private:
  CameraModel camera_;
  std::optional<Tracker> tracker_;
  int frame_ = 0;
};

void check_pose(const Marker& marker, const Pose& truth) {
  CHECK(marker.track == 1);
  CHECK(marker.id == kId);
  const Eigen::Vector3d off = marker.pose.position - truth.position;
  CHECK(off.norm() < 0.004);
  CHECK(off.cwiseQuotient(marker.sigma_position).norm() < 6);
  CHECK(orientation_error(marker.pose.orientation, truth.orientation) < 0.03);
}

}  // namespace

TEST_CASE(
    "what hides a sixth of the outline, dark, grey or bright, takes neither track, id nor pose") {
  for (const double cover : {30.0, 120.0, 230.0}) {
    CAPTURE(cover);
    Film film;
    film.warm_up();
    for (int i = 0; i < 10; ++i) {
      CAPTURE(i);
      const auto markers = film.show(
          [cover](double grey, double x, double y) { return x > 0.4 && y > 0.4 ? cover : grey; });
      REQUIRE(markers.size() == 1);
      check_pose(markers[0], film.truth);
    }
  }
}

TEST_CASE("glare over some teeth and the rim takes neither track, id nor pose") {
  Film film;
  film.warm_up();
  for (int i = 0; i < 10; ++i) {
    CAPTURE(i);
    const auto markers = film.show([](double grey, double x, double y) {
      return grey + 180 * std::exp(-(std::pow(x - 0.5, 2) + std::pow(y + 0.2, 2)) / 0.05);
    });
    REQUIRE(markers.size() == 1);
    check_pose(markers[0], film.truth);
  }
}

TEST_CASE("the hard edge of a shadow across a marker takes neither track, id nor pose") {
  for (const double place : {-0.5, 0.0, 0.6}) {
    for (const double angle : {0.0, 1.0, 4.0}) {
      CAPTURE(place);
      CAPTURE(angle);
      Film film;
      film.warm_up();
      for (int i = 0; i < 3; ++i) {
        const auto markers = film.show([&](double grey, double x, double y) {
          return x * std::cos(angle) + y * std::sin(angle) > place ? grey * 0.5 : grey;
        });
        REQUIRE(markers.size() == 1);
        check_pose(markers[0], film.truth);
      }
    }
  }
}

TEST_CASE("a marker that is taken away while half hidden is not reported as still there") {
  Film film;
  film.warm_up();
  const auto hide = [](double share) {
    return [share](double grey, double x, double) { return x > 1 - 2 * share ? 120.0 : grey; };
  };
  film.show(hide(0.2));
  film.show(hide(0.6));
  for (int i = 0; i < 3; ++i) CHECK(film.show(hide(1.5)).empty());
}

TEST_CASE("while another word is read than the track is known by, the turn is not held for sure") {
  Film film;
  film.warm_up();
  const auto markers = film.show([](double grey, double, double) { return grey; }, 5);
  REQUIRE(markers.size() == 1);
  CHECK(markers[0].id == kId);
  const double turn = orientation_error(markers[0].pose.orientation, film.truth.orientation);
  const double sigma = markers[0].sigma_rotation.norm();
  CHECK((turn < 0.02 || sigma > 1));
}
