#include "bench/common/apriltag_system.hpp"

extern "C" {
#include <apriltag/apriltag.h>
#include <apriltag/apriltag_pose.h>
#include <apriltag/common/image_u8.h>
#include <apriltag/common/matd.h>
#include <apriltag/tag16h5.h>
#include <apriltag/tag36h11.h>
}

#include <Eigen/Dense>
#include <array>
#include <cstdlib>
#include <optional>
#include <string>
#include <utility>

namespace roundel::bench {

namespace {

// Settings that are fair (METHOD.md section 9, item 10): one corrected bit, and a decision margin
// without which 16h5 gives hundreds of false tags.
constexpr int kCorrectedBits = 1;
constexpr float kMinDecisionMargin = 30;

struct FamilyKind {
  const char* name;
  apriltag_family_t* (*create)();
  void (*destroy)(apriltag_family_t*);
};
constexpr std::array<FamilyKind, 2> kFamilies = {
    {{"apriltag-16h5", tag16h5_create, tag16h5_destroy},
     {"apriltag-36h11", tag36h11_create, tag36h11_destroy}}};

using Family = std::unique_ptr<apriltag_family_t, void (*)(apriltag_family_t*)>;
using TagDetector = std::unique_ptr<apriltag_detector_t, void (*)(apriltag_detector_t*)>;
using Detections = std::unique_ptr<zarray_t, void (*)(zarray_t*)>;
// Debian's library does not export matd_destroy(), which is free().
using Matrix = std::unique_ptr<matd_t, void (*)(void*)>;
using Image = std::unique_ptr<image_u8_t, void (*)(image_u8_t*)>;

std::vector<SquarePattern> patterns_of(const FamilyKind& kind) {
  const Family family(kind.create(), kind.destroy);
  std::vector<SquarePattern> patterns;
  for (std::uint32_t id = 0; id < family->ncodes; ++id) {
    const Image image(apriltag_to_image(family.get(), static_cast<int>(id)), image_u8_destroy);
    const int border = (family->total_width - family->width_at_border) / 2;
    SquarePattern pattern;
    pattern.cells = family->width_at_border;
    for (int row = 0; row < pattern.cells; ++row) {
      for (int column = 0; column < pattern.cells; ++column) {
        pattern.white.push_back(image->buf[(row + border) * image->stride + column + border] > 127);
      }
    }
    patterns.push_back(std::move(pattern));
  }
  return patterns;
}

// The homography that takes `from` to `to`, with its last element 1.
Eigen::Matrix3d homography(const std::array<Eigen::Vector2d, 4>& from,
                           const std::array<Eigen::Vector2d, 4>& to) {
  Eigen::Matrix<double, 8, 8> a;
  Eigen::Matrix<double, 8, 1> b;
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector2d p = from[static_cast<std::size_t>(i)],
                          q = to[static_cast<std::size_t>(i)];
    a.row(2 * i) << p.x(), p.y(), 1, 0, 0, 0, -q.x() * p.x(), -q.x() * p.y();
    a.row(2 * i + 1) << 0, 0, 0, p.x(), p.y(), 1, -q.y() * p.x(), -q.y() * p.y();
    b.segment<2>(2 * i) = q;
  }
  const Eigen::Matrix<double, 8, 1> h = a.fullPivLu().solve(b);
  Eigen::Matrix3d result;
  result << h[0], h[1], h[2], h[3], h[4], h[5], h[6], h[7], 1;
  return result;
}

class AprilTagSystem final : public System {
 public:
  AprilTagSystem(const Experiment& experiment, const FamilyKind& kind, std::string name,
                 int decimate)
      : experiment_(experiment),
        name_(std::move(name)),
        family_(kind.create(), kind.destroy),
        detector_(apriltag_detector_create(), apriltag_detector_destroy) {
    apriltag_detector_add_family_bits(detector_.get(), family_.get(), kCorrectedBits);
    detector_->quad_decimate = static_cast<float>(decimate);
    detector_->nthreads = 1;
  }

  const std::string& name() const override { return name_; }
  int id_count() const override { return static_cast<int>(family_->ncodes); }

  std::span<const Sighting> look(const LumaView& picture) override {
    // The detector only reads its input, but takes it without const.
    image_u8_t image = {picture.width, picture.height, static_cast<int>(picture.row_stride),
                        const_cast<std::uint8_t*>(picture.data)};
    const Detections detections(apriltag_detector_detect(detector_.get(), &image),
                                apriltag_detections_destroy);
    sightings_.clear();
    for (int i = 0; i < zarray_size(detections.get()); ++i) {
      apriltag_detection_t* detection = nullptr;
      zarray_get(detections.get(), i, static_cast<void*>(&detection));
      if (detection->decision_margin < kMinDecisionMargin) continue;
      if (const auto sighting = sighting_of(*detection)) sightings_.push_back(*sighting);
    }
    return sightings_;
  }

 private:
  std::optional<Sighting> sighting_of(apriltag_detection_t& detection) const {
    // Corners through the lens; then everything is done in normalised coordinates.
    static const std::array<Eigen::Vector2d, 4> kTagCorners = {
        Eigen::Vector2d(-1, 1), Eigen::Vector2d(1, 1), Eigen::Vector2d(1, -1),
        Eigen::Vector2d(-1, -1)};
    std::array<Eigen::Vector2d, 4> corners;
    for (std::size_t i = 0; i < 4; ++i) {
      // AprilTag's first pixel has its centre at (0.5, 0.5).
      const auto point =
          experiment_.camera.normalise({detection.p[i][0] - 0.5, detection.p[i][1] - 0.5});
      if (!point) return std::nullopt;
      corners[i] = *point;
      detection.p[i][0] = point->x();
      detection.p[i][1] = point->y();
    }
    const Eigen::Matrix3d h = homography(kTagCorners, corners);
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) {
        detection.H->data[row * 3 + column] = h(row, column);
      }
    }
    apriltag_detection_info_t info = {&detection, experiment_.diameter_m, 1, 1, 0, 0};
    apriltag_pose_t pose = {};
    estimate_tag_pose(&info, &pose);
    const Matrix rotation(pose.R, std::free), translation(pose.t, std::free);

    Sighting sighting;
    sighting.number = detection.id;
    Eigen::Matrix3d r;
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) r(row, column) = rotation->data[row * 3 + column];
    }
    // AprilTag's y points down on the page and z into it.
    const Eigen::Matrix3d turned = r * Eigen::Vector3d(1, -1, -1).asDiagonal();
    sighting.pose.orientation = with_positive_w(Eigen::Quaterniond(turned).normalized());
    sighting.pose.position = {translation->data[0], translation->data[1], translation->data[2]};
    const auto centre = experiment_.camera.project(sighting.pose.position);
    if (!centre) return std::nullopt;
    sighting.u = centre->x();
    sighting.v = centre->y();
    return sighting;
  }

  const Experiment& experiment_;
  std::string name_;
  Family family_;
  TagDetector detector_;
  std::vector<Sighting> sightings_;
};

Contender contender_of(const FamilyKind& kind, const std::string& name, int decimate) {
  return {
      name,
      [&kind](const Experiment& experiment) { return square_print(experiment, patterns_of(kind)); },
      [&kind, name, decimate](const Experiment& experiment) {
        Systems systems;
        systems.push_back(std::make_unique<AprilTagSystem>(experiment, kind, name, decimate));
        return systems;
      }};
}

}  // namespace

std::vector<Contender> apriltag_contenders() {
  std::vector<Contender> contenders;
  for (const FamilyKind& kind : kFamilies) contenders.push_back(contender_of(kind, kind.name, 1));
  return contenders;
}

Contender apriltag_contender(int decimate) {
  const FamilyKind& kind = kFamilies.back();
  return contender_of(kind, kind.name + std::string("-d") + std::to_string(decimate), decimate);
}

}  // namespace roundel::bench
