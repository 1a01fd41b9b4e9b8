#include "calibration/picture_calibration.hpp"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <vector>

#include "calibration/board_detector.hpp"
#include "calibration/intrinsic_refusal.hpp"
#include "calibration/intrinsic_start.hpp"

namespace roundel {
namespace {

constexpr int kMaxRounds = 8;
constexpr double kSettledPx = 0.002;

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
                                           IntrinsicOptions options) {
  options.spacing_m = board.spacing_m;
  if (pictures.empty()) throw std::runtime_error("there is no picture to calibrate with");
  const int width = pictures.front().width, height = pictures.front().height;
  PictureCalibration calibration;
  CameraModel camera = guessed_camera(width, height);
  std::vector<BoardView> views;
  for (int round = 1; round <= kMaxRounds; ++round) {
    BoardDetector detector(board, camera);
    BoardTally tally;
    views.clear();
    for (std::size_t i = 0; i < pictures.size(); ++i) {
      const BoardSighting sighting = detector.find(pictures[i], static_cast<int>(i));
      tally.add(sighting);
      views.push_back(sighting.view);
    }
    require_board(tally, board);
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
