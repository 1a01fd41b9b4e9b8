#pragma once

#include <array>
#include <span>
#include <vector>

#include "calibration/board.hpp"
#include "calibration/edge_width.hpp"
#include "calibration/homography.hpp"
#include "calibration/intrinsic_view.hpp"
#include "core/camera_model.hpp"
#include "core/luma_view.hpp"
#include "core/marker_search.hpp"
#include "core/observer.hpp"

namespace roundel {

// What one picture says about the board.
struct BoardSighting {
  BoardView view;            // empty unless enough markers lie as on the board
  int markers = 0;           // of the board's ids that were read
  int foreign = 0;           // ids read that the board does not have
  int misplaced = 0;         // markers that do not lie where the board has them
  double edge_width_px = 0;  // how wide the markers' edges are, across the most blurred direction;
                             // infinite without markers
};

// Finds the board in single pictures. The camera may be a guess: which markers there are and
// roughly where does not depend on it; the last hundredths of a pixel of a centre do, because the
// centre of an ellipse is not the image of the circle's centre. So a calibration detects again with
// the camera that it found.
class BoardDetector {
 public:
  // Throws std::invalid_argument for a board that can't be.
  BoardDetector(const Board& board, const CameraModel& camera);

  // The picture must have the camera's size. `picture` is the number that the view carries.
  BoardSighting find(const LumaView& frame, int picture = 0);

 private:
  struct Seen {
    int id = 0;
    double diameter_px = 0;
    std::array<PoseHypothesis, 2> poses;
  };

  void look(const LumaView& frame, BoardSighting& sighting);
  bool is_aligned(const Seen& seen, const Eigen::Matrix3d& homography) const;
  std::vector<bool> correctly_placed(std::span<const PlanePoint> points, double tolerance_px) const;
  void keep_placed(BoardSighting& sighting);
  BoardPoint point_of(const Seen& seen, const PoseHypothesis& hypothesis) const;
  PoseHypothesis with_board(const Seen& seen, const Pose& board_in_camera) const;

  Board board_;
  CameraModel camera_;
  MarkerSearch search_;
  Observer observer_;
  std::vector<Segment> segments_;
  std::vector<Seen> seen_;
  EdgeWidths edges_;
};

}  // namespace roundel
