#include "calibration/intrinsic_refusal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "calibration/picture_coverage.hpp"

namespace roundel {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;
constexpr std::size_t kMinRegions = 5;    // of nine; beyond them the lens would be a guess
constexpr double kMinTiltRange = 10;      // degrees between the two most different views
constexpr double kMaxFocalSigma = 0.005;  // relative
constexpr double kMaxErrorPx = 0.5;       // good ones have a tenth of it

// The largest angle between two views of the board, degrees.
double tilt_range(std::span<const ViewResult> views) {
  double least_cosine = 1;
  for (std::size_t i = 0; i < views.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      least_cosine = std::min(
          least_cosine, views[i].board_in_camera.normal().dot(views[k].board_in_camera.normal()));
    }
  }
  return std::acos(std::clamp(least_cosine, -1.0, 1.0)) * kDegrees;
}

}  // namespace

void BoardTally::add(const BoardSighting& sighting) {
  ++pictures;
  views += sighting.view.points.empty() ? 0 : 1;
  markers += sighting.markers;
  foreign += sighting.foreign;
  misplaced += sighting.misplaced;
}

void require_board(const BoardTally& tally, const Board& board) {
  if (tally.views > 0) return;
  if (tally.markers + tally.foreign == 0) {
    throw std::runtime_error(fmt::format(
        "no marker was found in {}; the board is printed by roundel markers --board, and --bits "
        "must be as printed (now {}); mirrored pictures can't be read",
        tally.pictures == 1 ? "the picture" : fmt::format("any of {} pictures", tally.pictures),
        board.bits));
  }
  if (tally.foreign > tally.markers) {
    throw std::runtime_error(fmt::format(
        "{} of {} markers have ids that a board of {} x {} does not have (1 to {}): --columns, "
        "--rows, --bits and --hamming must be as printed",
        tally.foreign, tally.markers + tally.foreign, board.columns, board.rows, board.count()));
  }
  if (2 * tally.misplaced > tally.markers) {
    throw std::runtime_error(fmt::format(
        "the markers do not lie as on a board of {} columns and {} rows: --columns and --rows must "
        "be as printed",
        board.columns, board.rows));
  }
}

void require_views(std::span<const BoardView> views, std::size_t pictures, int width, int height) {
  const auto enough = std::count_if(views.begin(), views.end(), [](const BoardView& view) {
    return view.points.size() >= kMinBoardPoints;
  });
  if (enough < kMinViews) {
    throw std::runtime_error(fmt::format(
        "{} of {} pictures show at least {} markers of the board; at least {} are needed, some 15 "
        "are good",
        enough == 0 ? "none" : fmt::format("only {}", enough), pictures, kMinBoardPoints,
        kMinViews));
  }
  const PictureCoverage coverage = coverage_of(views, width, height);
  if (coverage.covered() < kMinRegions) {
    throw std::runtime_error(fmt::format(
        "the board was never seen in these parts of the picture: {}; what the lens does there is "
        "not known: add views with the board there",
        listed(coverage.missing())));
  }
}

void require_agreement(std::size_t left, std::size_t views) {
  if (3 * left >= 2 * views && left >= static_cast<std::size_t>(kMinViews)) return;
  throw std::runtime_error(fmt::format(
      "{} of {} views contradict the others: focus, zoom and size of the pictures must stay the "
      "same, and the board must be stiff and not move while a picture is taken",
      views - left, views));
}

void require_determined(const IntrinsicCalibration& calibration) {
  const CameraModel& camera = calibration.camera;
  const IntrinsicVector sigma = calibration.sigma();
  const double range = tilt_range(calibration.views);
  if (!(range >= kMinTiltRange)) {
    throw std::runtime_error(fmt::format(
        "all views show the board at nearly the same angle (they differ by {:.1f} degrees), from "
        "which no focal length follows: add views with the board tilted by 20 to 45 degrees, each "
        "of its sides towards the camera in turn",
        range));
  }
  if (!(calibration.error_px <= kMaxErrorPx)) {
    throw std::runtime_error(fmt::format(
        "no camera explains the views: the markers are off by {:.2f} pixels (good: below 0.1, at "
        "most "
        "{:.1f}); focus, zoom and size of the pictures must stay the same, and the board must be "
        "stiff and not move while a picture is taken",
        calibration.error_px, kMaxErrorPx));
  }
  const double focal_sigma = std::max(sigma[kFx] / camera.fx, sigma[kFy] / camera.fy);
  if (!sigma.allFinite() || focal_sigma > kMaxFocalSigma) {
    throw std::runtime_error(fmt::format(
        "the views leave the focal length uncertain by {:.2g} %, more than {:.1g} %: "
        "add views with the board closer, and tilted by 20 to 45 degrees in all directions",
        100 * focal_sigma, 100 * kMaxFocalSigma));
  }
  if (!std::isfinite(calibration.worst_px)) {
    throw std::runtime_error(
        "the lens that explains the views folds back inside the picture, where the board was not "
        "seen: add views with the board in the corners, or try --no-k3");
  }
}

}  // namespace roundel
