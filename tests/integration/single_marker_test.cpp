// One marker after another, drawn without noise: what is left is the method's own error.

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "core/detector.hpp"
#include "core/necklace.hpp"
#include "core/plane_projection.hpp"
#include "simulator/renderer.hpp"
#include "simulator/scene.hpp"

namespace roundel {
namespace {

CameraModel small_camera() {
  CameraModel camera;
  camera.width = 320;
  camera.height = 240;
  camera.fx = camera.fy = 921;
  camera.cx = 159.5;
  camera.cy = 119.5;
  return camera;
}

struct Errors {
  double distance = 0;  // of the position's error, share of the distance
  double orientation = 0;
};

Errors errors_of(const Imaging& imaging, const ResponseCurve& response, double incidence,
                 const Eigen::Vector3d& velocity) {
  const CameraModel camera = small_camera();
  constexpr int kId = 5, kBits = 8;
  SceneMarker marker;
  marker.bits = kBits;
  marker.word = NecklaceCode(kBits, 1).word(kId).value();
  marker.diameter_m = 0.084;
  marker.velocity = velocity;
  const Eigen::Vector3d centre(0.011, -0.007, 2), ray = -centre.normalized();
  const Eigen::Vector3d axis = Eigen::AngleAxisd(0.8, ray) * ray.unitOrthogonal();
  marker.pose = pose_from_circle({centre, Eigen::AngleAxisd(incidence, axis) * ray}, 0.6);
  Scene scene;
  scene.markers.push_back(marker);
  GreyImage image;
  Renderer(camera, imaging).render(scene, 1, image);

  DetectorParameters parameters;
  parameters.diameter_m = marker.diameter_m;
  parameters.response = response;
  Detector detector(parameters, camera);
  const auto found = detector.detect(image.view());
  REQUIRE(found.size() == 1);
  REQUIRE(found[0].id == kId);
  return {(found[0].pose.position - centre).norm() / centre.z(),
          orientation_error(found[0].pose.orientation, marker.pose.orientation)};
}

Imaging usual_imaging() {
  return {.black = 35, .white = 215, .floor = 120, .blur_px = 0.6};
}

constexpr double kDegree = std::numbers::pi / 180;

}  // namespace

TEST_CASE("tilt does not bias the distance, though rims are curved and teeth narrow") {
  for (const double incidence : {15.0, 30.0, 45.0, 60.0}) {
    CAPTURE(incidence);
    const Errors errors =
        errors_of(usual_imaging(), ResponseCurve::linear(), incidence * kDegree, {0, 0, 0});
    CHECK(errors.distance < 2e-4);
    CHECK(errors.orientation < 8e-4);
  }
}

TEST_CASE("with its response curve known, a camera with gamma is as good as a linear one") {
  Imaging imaging = usual_imaging();
  imaging.srgb = true;
  const Errors known = errors_of(imaging, ResponseCurve::srgb(), 0.5, {0, 0, 0});
  CHECK(known.distance < 2e-4);
  CHECK(known.orientation < 8e-4);
  // This is what it mends.
  const Errors unknown = errors_of(imaging, ResponseCurve::linear(), 0.5, {0, 0, 0});
  CHECK(unknown.distance > 4e-4);
}

TEST_CASE("blur by motion of a twelfth of the diameter moves the pose little") {
  Imaging imaging = usual_imaging();
  imaging.exposure_s = 0.02;
  const double speed = 0.084 / 12 / imaging.exposure_s;
  const Errors errors =
      errors_of(imaging, ResponseCurve::linear(), 0.5, {speed * 0.6, speed * 0.8, 0});
  CHECK(errors.distance < 6e-4);
  CHECK(errors.orientation < 2e-3);
}

}  // namespace roundel
