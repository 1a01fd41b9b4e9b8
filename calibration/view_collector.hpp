#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "calibration/board.hpp"
#include "calibration/board_detector.hpp"
#include "calibration/intrinsic_refusal.hpp"
#include "core/grey_image.hpp"
#include "core/luma_view.hpp"

namespace roundel {

// Where in a picture the board is, and how it is held.
struct BoardPlace {
  std::array<Eigen::Vector2d, 4> corners{};          // of the grid, pixels
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  // in a guessed camera's frame
};

// A picture that was kept, and what was seen in it.
struct CollectedView {
  std::string name;  // the caller's, for messages
  GreyImage picture;
  BoardSighting sighting;  // under a guessed camera
  BoardPlace place;
  double badness_px = 0;  // width of edges plus motion; the lower the better
};

// Chooses views for a calibration out of a stream of frames, live or from a video: those that show
// the board sharp and still, each clearly different from the others; a better one takes the place
// of one that it resembles. Copies the frames that it keeps.
class ViewCollector {
 public:
  enum class Outcome { kTaken, kReplaced, kNoBoard, kMoving, kBlurred, kAlike, kFull };

  static constexpr std::size_t kMaxViews = 40;      // out of a stream
  static constexpr std::size_t kMaxPictures = 200;  // in all

  // Throws std::invalid_argument for a board that can't be.
  ViewCollector(const Board& board, int width, int height);

  // The next frame of a stream; it must have the size given.
  Outcome offer(const LumaView& frame, const std::string& name);

  // A picture that somebody chose: kept if it shows enough of the board, whatever it is like, as
  // long as there is room.
  Outcome take(const LumaView& frame, const std::string& name);

  int width() const { return guess_.width; }
  int height() const { return guess_.height; }
  const std::vector<CollectedView>& views() const { return views_; }
  // Counted over all frames given.
  const BoardTally& tally() const { return tally_; }
  // What was seen in the frame given last.
  const BoardSighting& last() const { return last_; }

  // What to show the camera next; empty: enough (view_advice.hpp).
  std::vector<std::string> advice() const;

 private:
  bool look(const LumaView& frame);
  CollectedView made(const LumaView& frame, const std::string& name, double badness_px) const;
  double motion(const BoardView& before) const;
  double distance(const BoardPlace& place) const;

  CameraModel guess_;
  Board board_;
  BoardDetector detector_;
  double diagonal_px_ = 0;
  BoardTally tally_;
  BoardSighting last_;
  BoardPlace last_place_;
  std::vector<CollectedView> views_;
};

// "it is blurred", ... for people.
const char* describe(ViewCollector::Outcome outcome);

}  // namespace roundel
