#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "core/marker.hpp"
#include "simulator/truth.hpp"
#include "tools/distribution.hpp"

namespace roundel {

// Whether the published standard deviations are honest: of normal errors, 68 % lie within one
// standard deviation, and (error / deviation)^2 is 1 in the mean. By camera axes.
struct SigmaStatistics {
  std::int64_t count = 0;  // of markers with a sigma
  std::array<std::int64_t, 3> within_one{};
  std::array<double, 3> sum_of_squares{};

  void add(const Eigen::Vector3d& error, const Eigen::Vector3d& sigma);
};

// How the markers with a code, or those without, were seen.
struct MarkerStatistics {
  std::int64_t visible = 0;         // nothing keeps a detector from finding them
  std::int64_t found = 0;           // of these
  std::int64_t found_obscured = 0;  // not counted as visible (covered, cut), found all the same
  std::int64_t wrong_ids = 0;       // of all found: another's id, or one on a marker without a code
  std::int64_t late_wrong_ids = 0;  // of these, those not in the first frames of a track
  std::int64_t missing_ids = 0;     // of the visible ones found: coded, but reported as -1

  // Of the visible ones found; all but the first of those with a pose.
  Distribution image_px, position_m, normal_rad;
  Distribution orientation_rad;  // arccos |q1 . q2|; of coded ones, as only they have a yaw
  std::int64_t flips = 0;        // normal off by more than kFlip
  SigmaStatistics position_sigma;

  std::int64_t missed() const { return visible - found; }
};

// Holds what was reported of each frame against the truth. Frames are added in their order.
class TrackStatistics {
 public:
  static constexpr double kWithinPx = 5;           // further away it is another marker
  static constexpr std::int64_t kFirstFrames = 3;  // of a track, in which an id may still be wrong
  static constexpr double kFlip = 0.2;             // radians

  explicit TrackStatistics(double within_px = kWithinPx) : within_px_(within_px) {}

  // Throws std::invalid_argument unless the truth lists the same markers in every frame.
  void add(const FrameTruth& truth, std::span<const Marker> reported);
  // A frame of which nothing was reported, not even that it holds no marker: all are missed.
  void add_unanswered(const FrameTruth& truth);

  const MarkerStatistics& coded() const { return coded_; }
  const MarkerStatistics& plain() const { return plain_; }
  std::int64_t visible() const { return coded_.visible + plain_.visible; }
  std::int64_t found() const { return coded_.found + plain_.found; }
  std::int64_t late_wrong_ids() const { return coded_.late_wrong_ids + plain_.late_wrong_ids; }

  std::int64_t frames() const { return frames_; }
  std::int64_t unanswered_frames() const { return unanswered_; }
  std::int64_t complete_frames() const { return complete_; }  // every visible marker was found
  // Share of its frames in which the marker that was missed most often was found; nothing if none
  // was ever visible.
  std::optional<double> least_found_share() const;

  std::int64_t not_in_truth() const { return not_in_truth_; }  // reported where there is none
  std::int64_t not_in_truth_with_id() const { return not_in_truth_with_id_; }

  bool has_tracks() const { return !tracks_.empty(); }  // any track number was reported
  std::int64_t tracks_changed_marker() const { return tracks_changed_marker_; }
  // A marker's track number changed while the marker was visible all the time.
  std::int64_t markers_changed_track() const { return markers_changed_track_; }
  // Id swaps: sightings that are one or the other.
  std::int64_t swaps() const { return swaps_; }

 private:
  struct TrueMarker {
    MarkerKind kind;
    int id;
    std::int64_t visible = 0, found = 0;  // frames
    std::int64_t track = 0;               // seen last since it came in sight; 0: none
  };
  struct Track {
    std::int64_t frames = 0;
    std::optional<std::size_t> marker;  // seen last under this number
  };

  void begin(const FrameTruth& truth);
  void judge_id(const MarkerTruth& truth, const Marker& reported, MarkerStatistics& kind);
  void judge_track(std::size_t index, bool visible, std::int64_t track);
  MarkerStatistics& of(MarkerKind kind) { return kind == MarkerKind::WhyCode ? coded_ : plain_; }

  double within_px_;
  MarkerStatistics coded_, plain_;
  std::vector<TrueMarker> markers_;  // as the truth lists them
  std::unordered_map<std::int64_t, Track> tracks_;
  std::int64_t frames_ = 0, unanswered_ = 0, complete_ = 0;
  std::int64_t not_in_truth_ = 0, not_in_truth_with_id_ = 0;
  std::int64_t tracks_changed_marker_ = 0, markers_changed_track_ = 0, swaps_ = 0;
};

}  // namespace roundel
