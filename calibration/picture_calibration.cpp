#include "calibration/picture_calibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "calibration/board_detector.hpp"
#include "calibration/intrinsic_start.hpp"

namespace roundel {
namespace {

constexpr int kMaxRounds = 8;
constexpr double kSettledPx = 0.002;

// Says why there is no view at all, when that has one cause; otherwise the calibration will tell.
void explain_no_view(std::span<const BoardSighting> sightings, const Board& board) {
  int views = 0, markers = 0, foreign = 0, misplaced = 0;
  for (const BoardSighting& sighting : sightings) {
    views += sighting.view.points.empty() ? 0 : 1;
    markers += sighting.markers;
    foreign += sighting.foreign;
    misplaced += sighting.misplaced;
  }
  if (views > 0) return;
  if (markers + foreign == 0) {
    throw std::runtime_error(fmt::format(
        "no marker was found in any of {} pictures; the board is printed by roundel markers "
        "--board, and --bits must be as printed (now {}); mirrored pictures can't be read",
        sightings.size(), board.bits));
  }
  if (foreign > markers) {
    throw std::runtime_error(fmt::format(
        "{} of {} markers have ids that a board of {} x {} does not have (1 to {}): --columns, "
        "--rows, --bits and --hamming must be as printed",
        foreign, markers + foreign, board.columns, board.rows, board.count()));
  }
  if (2 * misplaced > markers) {
    throw std::runtime_error(fmt::format(
        "the markers do not lie as on a board of {} columns and {} rows: --columns and --rows must "
        "be as printed",
        board.columns, board.rows));
  }
}

// The most that two cameras differ in where they see a place of the picture.
double change_px(const CameraModel& a, const CameraModel& b) {
  constexpr int kPlaces = 8;
  double most = 0;
  for (int j = 0; j <= kPlaces; ++j) {
    for (int i = 0; i <= kPlaces; ++i) {
      const Eigen::Vector2d pixel((a.width - 1.0) * i / kPlaces, (a.height - 1.0) * j / kPlaces);
      const auto ray = a.normalise(pixel);
      if (ray) most = std::max(most, (b.to_pixel(b.distort(*ray)) - pixel).norm());
    }
  }
  return most;
}

}  // namespace

PictureCalibration calibrate_from_pictures(Pictures pictures, const Board& board,
                                           const IntrinsicOptions& options) {
  if (pictures.empty()) throw std::runtime_error("there is no picture to calibrate with");
  const int width = pictures.front().width, height = pictures.front().height;
  PictureCalibration calibration;
  CameraModel camera = guessed_camera(width, height);
  std::vector<BoardSighting> sightings;
  std::vector<BoardView> views;
  for (int round = 1; round <= kMaxRounds; ++round) {
    BoardDetector detector(board, camera);
    sightings.clear();
    views.clear();
    for (std::size_t i = 0; i < pictures.size(); ++i) {
      sightings.push_back(detector.find(pictures[i], static_cast<int>(i)));
      views.push_back(sightings.back().view);
    }
    explain_no_view(sightings, board);
    const auto start = round == 1 ? std::nullopt : std::optional(camera);
    calibration.result = calibrate_intrinsics(views, width, height, options, start);
    calibration.rounds = round;
    calibration.last_change_px = change_px(camera, calibration.result.camera);
    camera = calibration.result.camera;
    if (round > 1 && calibration.last_change_px < kSettledPx) break;
  }
  return calibration;
}

}  // namespace roundel
