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
constexpr double kDistinct = 0.06;     // between the corners of two views, root mean square
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
    last_corners_[i] = apply(*homography, board_.centre_of(ids[i]));
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

// Of the frame given last from a view, pixels.
double ViewCollector::distance(const CollectedView& view) const {
  double sum = 0;
  for (std::size_t i = 0; i < last_corners_.size(); ++i)
    sum += (view.corners[i] - last_corners_[i]).squaredNorm();
  return std::sqrt(sum / static_cast<double>(last_corners_.size()));
}

CollectedView ViewCollector::made(const LumaView& frame, const std::string& name,
                                  double badness_px) const {
  CollectedView view{name, {}, last_, last_corners_, badness_px};
  copy(frame, view.picture);
  return view;
}

ViewCollector::Verdict ViewCollector::take(const LumaView& frame, const std::string& name) {
  if (!look(frame)) return Verdict::kNoBoard;
  views_.push_back(made(frame, name, last_.edge_width_px));
  return Verdict::kTaken;
}

ViewCollector::Verdict ViewCollector::offer(const LumaView& frame, const std::string& name) {
  const BoardView before = std::exchange(last_, {}).view;
  if (!look(frame)) return Verdict::kNoBoard;
  const double moved = motion(before);
  const bool cut = moved > kCut * diagonal_px_;
  if (!cut && moved > kMaxMotion * diagonal_px_) return Verdict::kMoving;
  if (last_.edge_width_px > std::max(kMinMaxEdge, kMaxEdge * diagonal_px_))
    return Verdict::kBlurred;
  // After a cut nothing is known about motion: the next frame, if it stays, is the better one.
  const double badness = last_.edge_width_px + (cut ? kMaxMotion * diagonal_px_ : moved);
  const auto nearest = std::min_element(
      views_.begin(), views_.end(),
      [this](const CollectedView& a, const CollectedView& b) { return distance(a) < distance(b); });
  if (nearest != views_.end() && distance(*nearest) < kDistinct * diagonal_px_) {
    if (!(badness < kBetter * nearest->badness_px)) return Verdict::kAlike;
    last_.view.picture = nearest->sighting.view.picture;
    *nearest = made(frame, name, badness);
    return Verdict::kReplaced;
  }
  if (views_.size() >= kMaxViews) return Verdict::kFull;
  views_.push_back(made(frame, name, badness));
  return Verdict::kTaken;
}

std::vector<std::string> ViewCollector::advice() const {
  std::vector<BoardView> seen;
  for (const CollectedView& view : views_) seen.push_back(view.sighting.view);
  return view_advice(seen, guess_);
}

const char* describe(ViewCollector::Verdict verdict) {
  switch (verdict) {
    case ViewCollector::Verdict::kTaken:
      return "taken";
    case ViewCollector::Verdict::kReplaced:
      return "taken in place of a worse one";
    case ViewCollector::Verdict::kNoBoard:
      return "the board is not in it, or too little of it";
    case ViewCollector::Verdict::kMoving:
      return "the board moves";
    case ViewCollector::Verdict::kBlurred:
      return "it is blurred";
    case ViewCollector::Verdict::kAlike:
      return "much like one taken before";
    case ViewCollector::Verdict::kFull:
      return "enough views are there";
  }
  return "";
}

}  // namespace roundel
