#include "calibration/view_advice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "calibration/intrinsic_start.hpp"
#include "calibration/picture_coverage.hpp"

namespace roundel {
namespace {

constexpr double kTilt = 15 * std::numbers::pi / 180;
constexpr double kNear = 0.4;  // of the picture's diagonal, that the markers span

// What single views contribute.
struct Contributions {
  std::array<bool, 4> nearer{};  // left, right, top, bottom side of the board, as in the picture
  bool upright = false, on_its_side = false;
  bool near = false;
};

double span_of(const BoardView& view) {
  double span = 0;
  for (const BoardPoint& a : view.points) {
    for (const BoardPoint& b : view.points) span = std::max(span, (a.pixel - b.pixel).norm());
  }
  return span;
}

void add(const BoardView& view, const CameraModel& camera, Contributions& all) {
  const auto pose = board_pose(view, camera);
  if (!pose) return;
  // A board whose face looks to the picture's right has its left side nearer.
  const Eigen::Vector3d normal = pose->normal();
  all.nearer[0] |= normal.x() > std::sin(kTilt);
  all.nearer[1] |= normal.x() < -std::sin(kTilt);
  all.nearer[2] |= normal.y() > std::sin(kTilt);
  all.nearer[3] |= normal.y() < -std::sin(kTilt);
  const Eigen::Vector3d right = pose->orientation * Eigen::Vector3d::UnitX();
  const bool level = std::abs(right.x()) > std::abs(right.y());
  all.upright |= level;
  all.on_its_side |= !level;
  all.near |= span_of(view) > kNear * std::hypot(camera.width, camera.height);
}

}  // namespace

std::vector<std::string> view_advice(std::span<const BoardView> views, const CameraModel& camera) {
  static constexpr std::array<const char*, 4> kSides = {"left", "right", "top", "bottom"};
  Contributions all;
  PictureCoverage coverage(camera.width, camera.height);
  std::size_t count = 0;
  for (const BoardView& view : views) {
    if (view.points.size() < kMinBoardPoints) continue;
    ++count;
    coverage.add(view);
    add(view, camera, all);
  }
  std::vector<std::string> advice;
  const std::vector<std::string> regions = coverage.missing();
  if (!regions.empty()) {
    advice.push_back(fmt::format("move it to these parts of the picture: {}", listed(regions)));
  }
  std::vector<std::string> sides;
  for (std::size_t i = 0; i < kSides.size(); ++i) {
    if (!all.nearer[i]) sides.emplace_back(kSides[i]);
  }
  if (!sides.empty()) {
    advice.push_back(
        fmt::format("tilt it by 20 to 40 degrees with these sides, as in the picture, "
                    "nearer in turn: {}",
                    listed(sides)));
  }
  if (!all.on_its_side || !all.upright) advice.emplace_back("turn it by 90 degrees in some views");
  if (!all.near) advice.emplace_back("bring it closer: let it fill half of the picture");
  if (count < kGoodViews) {
    advice.push_back(fmt::format("{} more views: {} of {}", kGoodViews - count, count, kGoodViews));
  }
  return advice;
}

}  // namespace roundel
