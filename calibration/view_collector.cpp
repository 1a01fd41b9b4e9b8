#include "calibration/view_collector.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "calibration/homography.hpp"
#include "calibration/intrinsic_start.hpp"
#include "calibration/view_advice.hpp"

namespace roundel {
namespace {

// Shares of the picture's diagonal.
constexpr double kDistinct = 0.04;     // between the corners of two views, root mean square
constexpr double kTiltShare = 0.2;     // that a tilt of one radian counts for
constexpr double kMaxMotion = 0.0015;  // from frame to frame: a rolling shutter skews what moves
constexpr double kCut = 0.1;           // more from frame to frame is no motion but another scene
constexpr double kMaxEdge = 0.003;
constexpr double kMinMaxEdge = 6;  // pixels

constexpr double kBetter = 0.8;  // of the badness of the view to be replaced

void copy(const LumaView& frame, GreyImage& picture) {
  picture.resize(frame.width, frame.height);
  auto* pixel = picture.pixels.data();
  for (int v = 0; v < frame.height; ++v) {
    for (int u = 0; u < frame.width; ++u) *pixel++ = frame.at(u, v);
  }
}

}  // namespace

ViewCollector::ViewCollector(const Board& board, int width, int height)
    : guess_(guessed_camera(width, height)),
      board_(board),
      detector_(board, guess_),
      diagonal_px_(std::hypot(width, height)) {}

// Whether the frame shows enough of the board.
bool ViewCollector::look(const LumaView& frame) {
  last_ = detector_.find(frame, static_cast<int>(views_.size()));
  tally_.add(last_);
  std::vector<PlanePoint> points;
  for (const BoardPoint& point : last_.view.points) points.push_back({point.on_board, point.pixel});
  const auto homography = fit_homography(points);
  if (!homography) return false;
  const std::array<int, 4> ids = {1, board_.columns, board_.count() - board_.columns + 1,
                                  board_.count()};
  for (std::size_t i = 0; i < ids.size(); ++i)
    last_place_.corners[i] = apply(*homography, board_.centre_of(ids[i]));
  const auto pose = board_pose(last_.view, guess_);
  last_place_.normal = pose ? pose->normal() : Eigen::Vector3d::Zero();
  return true;
}

// Middling distance of markers from where they were in the frame before, pixels; infinite if that
// showed none of them.
double ViewCollector::motion(const BoardView& before) const {
  std::vector<double> moves;
  for (const BoardPoint& now : last_.view.points) {
    for (const BoardPoint& then : before.points) {
      if (then.id == now.id) moves.push_back((now.pixel - then.pixel).norm());
    }
  }
  if (moves.empty()) return std::numeric_limits<double>::infinity();
  const auto middle = moves.begin() + static_cast<std::ptrdiff_t>(moves.size() / 2);
  std::nth_element(moves.begin(), middle, moves.end());
  return *middle;
}

// Of the frame given last from a view, pixels: how far the board's corners have moved, and a tilt
// as if it moved them by a share of the picture, because a tilted board near the camera has its
// corners where a frontal one further away has them.
double ViewCollector::distance(const BoardPlace& place) const {
  double sum = 0;
  for (std::size_t i = 0; i < place.corners.size(); ++i)
    sum += (place.corners[i] - last_place_.corners[i]).squaredNorm();
  const double tilt = kTiltShare * diagonal_px_ * (place.normal - last_place_.normal).norm();
  return std::sqrt(sum / static_cast<double>(place.corners.size()) + tilt * tilt);
}

CollectedView ViewCollector::made(const LumaView& frame, const std::string& name,
                                  double badness_px) const {
  CollectedView view{name, {}, last_, last_place_, badness_px};
  copy(frame, view.picture);
  return view;
}

ViewCollector::Outcome ViewCollector::take(const LumaView& frame, const std::string& name) {
  if (!look(frame)) return Outcome::kNoBoard;
  if (views_.size() >= kMaxPictures) return Outcome::kFull;
  views_.push_back(made(frame, name, last_.edge_width_px));
  return Outcome::kTaken;
}

ViewCollector::Outcome ViewCollector::offer(const LumaView& frame, const std::string& name) {
  const BoardView before = std::exchange(last_, {}).view;
  if (!look(frame)) return Outcome::kNoBoard;
  const double moved = motion(before);
  const bool cut = moved > kCut * diagonal_px_;
  if (!cut && moved > kMaxMotion * diagonal_px_) return Outcome::kMoving;
  if (last_.edge_width_px > std::max(kMinMaxEdge, kMaxEdge * diagonal_px_))
    return Outcome::kBlurred;
  // After a cut nothing is known about motion: the next frame, if it stays, is the better one.
  const double badness = last_.edge_width_px + (cut ? kMaxMotion * diagonal_px_ : moved);
  const auto nearest = std::min_element(views_.begin(), views_.end(),
                                        [this](const CollectedView& a, const CollectedView& b) {
                                          return distance(a.place) < distance(b.place);
                                        });
  if (nearest != views_.end() && distance(nearest->place) < kDistinct * diagonal_px_) {
    if (!(badness < kBetter * nearest->badness_px)) return Outcome::kAlike;
    last_.view.picture = nearest->sighting.view.picture;
    *nearest = made(frame, name, badness);
    return Outcome::kReplaced;
  }
  if (views_.size() >= kMaxViews) return Outcome::kFull;
  views_.push_back(made(frame, name, badness));
  return Outcome::kTaken;
}

std::vector<std::string> ViewCollector::advice() const {
  std::vector<BoardView> seen;
  for (const CollectedView& view : views_) seen.push_back(view.sighting.view);
  return view_advice(seen, guess_);
}

const char* describe(ViewCollector::Outcome outcome) {
  switch (outcome) {
    case ViewCollector::Outcome::kTaken:
      return "taken";
    case ViewCollector::Outcome::kReplaced:
      return "taken in place of a worse one";
    case ViewCollector::Outcome::kNoBoard:
      return "the board is not in it, or too little of it";
    case ViewCollector::Outcome::kMoving:
      return "the board moves";
    case ViewCollector::Outcome::kBlurred:
      return "it is blurred";
    case ViewCollector::Outcome::kAlike:
      return "much like one taken before";
    case ViewCollector::Outcome::kFull:
      return "enough views are there";
  }
  return "";
}

}  // namespace roundel
